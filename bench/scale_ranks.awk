# scale_ranks.awk - the table of docs/lammps.md, from what build/couple/ranks measured: awk -f bench/scale_ranks.awk
# SPDX-License-Identifier: MIT
# Lengths in radii. A rank has a cube of the bed; messages cost latency and bytes over bandwidth.
function ceil(x) { return x == int(x) ? x : int(x) + 1 }
function short(x) { return x >= 100 ? sprintf("%.0f", x) : sprintf("%.2g", x) }
function row(all, ranks,    n, side, halo, near, lists, map, bytes, messages, making, heat, gone, link) {
    n = all / ranks
    side = (n * volume) ^ (1 / 3)
    halo = ranks == 1 ? 0 : (6 * side ^ 2 * reach + 3 * pi * side * reach ^ 2 + 4 / 3 * pi * reach ^ 3) / volume
    if (halo > all - n) halo = all - n
    near = (2 * ceil(reach / side) + 1) ^ 3 - 1
    if (near > ranks - 1) near = ranks - 1
    map = all * volume / (cutoff / 4) ^ 3 / 8
    if (map > 2 ^ 21) map = 2 ^ 21
    logs = log(ranks) / log(2)
    # making rows: particles of the halo and requests; 40 collective calls; boxes; numbers; the map
    messages = 2 * near + 2 * 40 * logs
    bytes = ranks == 1 ? 0 : 72 * halo + 4 * halo + 48 * ranks + 2 * 2 * ranks * logs + 2 * map
    making = messages * latency + bytes / bandwidth
    # a step of heat: values of the halo there and powers back; 3 reductions
    heat_messages = 2 * near + 6 * logs
    heat_bytes = 16 * halo
    heat = heat_messages * latency + heat_bytes / bandwidth
    # ... the first one after particles have changed ranks: entries, questions and replies, and requests
    gone = ranks == 1 ? 0 : 6 / 4 * moved / side * n
    link = (3 * (gone > ranks - 1 ? ranks - 1 : gone) + near + 2 * 18 * logs) * latency + (44 * gone + 4 * 2 * ranks * logs) / bandwidth
    printf "| 1e%d | %d | %d | %d | %d", int(log(all) / log(10) + .5), ranks, n, halo, near
    printf " | %s | %s", short((fixed + particle * n + other * halo) / 1e9), short(bytes / 1e6)
    printf " | %s | %s", short(seconds_row * n), short(making)
    printf " | %s | %s", short(heat_bytes / 1e6), short(seconds_heat * n * 1e3)
    printf " | %s | %s |\n", short(heat * 1e3), short(link * 1e3)
}
BEGIN {
    pi = atan2(0, -1); volume = 4 / 3 * pi / .588; cutoff = 10; reach = cutoff + 1.5
    moved = .2                                         # since rows were made, in any direction
    latency = 2e-6; bandwidth = 1e9                    # [s], [bytes/s] of a rank: stated
    seconds_row = 7.5e-5; seconds_heat = 3e-7          # of a particle at emissivity 0.8: measured
    fixed = 7e6; particle = 3700; other = 1200         # bytes of a rank: measured
    row(1e6, 1); row(1e6, 100); row(1e6, 1e4); row(1e7, 1e4); row(1e8, 100); row(1e8, 1e4); row(1e9, 1e4); row(1e10, 1e4)
}
