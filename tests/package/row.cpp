// row.cpp - a user of the installed library in C++17: a pair, and a row. SPDX-License-Identifier: MIT
#include <fibrad.h>
#include <fibrad_furnace.h>
#include <fibrad_host.h>
#include <fibrad_surface.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

int main() {
    // A sphere and six that touch it: nothing lies between it and them.
    const std::array<double, 7> x{0, 2, -2}, y{0, 0, 0, 2, -2}, z{0, 0, 0, 0, 0, 2, -2}, r{1, 1, 1, 1, 1, 1, 1};
    fibrad_spheres spheres{};
    spheres.x = x.data();
    spheres.y = y.data();
    spheres.z = z.data();
    spheres.r = r.data();
    spheres.n = 7;

    double pair = 0;
    fibrad_scene *scene = nullptr;
    std::vector<unsigned char> scene_memory(fibrad_scene_size(7, 0)), work_memory(FIBRAD_WORK_BYTES(64, 7));
    fibrad_work work{};
    work.memory.block = work_memory.data();
    work.memory.size = work_memory.size();
    if (fibrad_pair_exact(1, 1, 0, &pair) != FIBRAD_OK) return 1;
    if (fibrad_scene_init(&scene, scene_memory.data(), scene_memory.size(), nullptr, &spheres, nullptr) != FIBRAD_OK)
        return 1;

    std::vector<std::uint32_t> col(7);
    std::vector<double> f(7);
    fibrad_row row{};
    row.col = col.data();
    row.f = f.data();
    row.capacity = 7;
    const fibrad_beam_rule rule{};
    if (fibrad_beam_row(scene, &work, 0, &rule, &row) != FIBRAD_OK || row.length != 6) return 1;

    double sum = row.escaped;
    for (std::uint32_t k = 0; k < row.length; k++) {
        std::printf("F 0 %u %.17g\n", unsigned(col[k]), f[k]);
        if (std::fabs(f[k] - pair) > 1e-3) return 1;
        sum += f[k];
    }
    std::printf("escaped %.17g\n", row.escaped);
    return std::fabs(sum - 1) > 1e-12 || std::fabs(pair - 0.0755868184216124) > 1e-15;
}
