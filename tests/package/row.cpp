// row.cpp - a user of the installed library in C++17: a pair, and a row. SPDX-License-Identifier: MIT
#include <fibrad.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

struct alignas(64) Line {
    unsigned char byte[64];
};

static std::vector<Line> block(std::size_t bytes) { return std::vector<Line>((bytes + 63) / 64); }

int main() {
    // A sphere and six that touch it: nothing lies between it and them.
    const std::array<double, 7> x{0, 2, -2}, y{0, 0, 0, 2, -2}, z{0, 0, 0, 0, 0, 2, -2}, r{1, 1, 1, 1, 1, 1, 1};
    const fibrad_spheres spheres{x.data(), y.data(), z.data(), r.data(), 7};
    fibrad_scene_config config{};
    config.spheres = spheres.n;

    double pair = 0;
    fibrad_scene *scene = nullptr;
    fibrad_work *work = nullptr;
    auto scene_memory = block(fibrad_scene_size(&config)), work_memory = block(fibrad_work_size(nullptr));
    if (fibrad_pair_exact(1, 1, 0, &pair) != FIBRAD_OK) return 1;
    if (fibrad_scene_init(&scene, scene_memory.data(), 64 * scene_memory.size(), &config, &spheres, nullptr) !=
        FIBRAD_OK)
        return 1;
    if (fibrad_work_init(&work, work_memory.data(), 64 * work_memory.size(), nullptr) != FIBRAD_OK) return 1;

    std::vector<std::uint32_t> col(7);
    std::vector<double> f(7);
    fibrad_row row{};
    row.col = col.data();
    row.f = f.data();
    row.capacity = 7;
    const fibrad_beam_rule rule{};
    if (fibrad_beam_row(scene, work, 0, &rule, &row) != FIBRAD_OK || row.length != 6) return 1;

    double sum = row.escaped;
    for (std::uint32_t k = 0; k < row.length; k++) {
        std::printf("F 0 %u %.17g\n", unsigned(col[k]), f[k]);
        if (std::fabs(f[k] - pair) > 1e-3) return 1;
        sum += f[k];
    }
    std::printf("escaped %.17g\n", row.escaped);
    return std::fabs(sum - 1) > 1e-12 || std::fabs(pair - 0.0755868184216124) > 1e-15;
}
