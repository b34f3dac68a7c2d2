// matrix_vectors.cpp - a matrix of view factors whose memory lies in vectors. SPDX-License-Identifier: MIT
//
//     c++ -std=c++11 docs/examples/matrix_vectors.cpp -Ikernel build/libfibrad.a -lm -o matrix_vectors
#include <cstdint>
#include <cstdio>
#include <new>
#include <vector>
#include "fibrad.h"

// Work memory of one thread, and the rows it has computed.
class Rows {
  public:
    Rows() {
        work.memory.resize = rows.memory.resize = resize;
        work.memory.context = &work_bytes;
        rows.memory.context = &rows_bytes;
    }
    Rows(const Rows &) = delete; // the kernel keeps pointers into the blocks
    Rows &operator=(const Rows &) = delete;

    int add(const fibrad_scene *scene, std::uint32_t i) {
        fibrad_row row{};
        row.rows = &rows;
        return fibrad_beam_row(scene, &work, i, nullptr, &row);
    }
    const fibrad_rows &all() const { return rows; }

  private:
    static void *resize(void *context, void *, std::size_t size) {
        auto &bytes = *static_cast<std::vector<unsigned char> *>(context);
        try {
            bytes.resize(size);
        } catch (const std::bad_alloc &) { // no exception may pass through the kernel
            return nullptr;
        }
        return bytes.data();
    }
    std::vector<unsigned char> work_bytes, rows_bytes;
    fibrad_work work{};
    fibrad_rows rows{};
};

static int view_factors(const fibrad_spheres &spheres, std::vector<unsigned char> &memory, fibrad_factors &factors) {
    std::vector<unsigned char> block(fibrad_scene_size(spheres.n, 0));
    fibrad_scene *scene = nullptr;
    fibrad_matrix *matrix = nullptr;
    Rows rows;
    int status = fibrad_scene_init(&scene, block.data(), block.size(), nullptr, &spheres, nullptr);
    for (std::uint32_t i = 0; i < spheres.n && status == FIBRAD_OK; i++) status = rows.add(scene, i);
    if (status != FIBRAD_OK) return status;
    memory.resize(fibrad_matrix_size(scene, &rows.all(), 1, nullptr));
    status = fibrad_matrix_init(&matrix, memory.data(), memory.size(), scene, &rows.all(), 1, nullptr, nullptr);
    if (status == FIBRAD_OK) status = fibrad_matrix_close(matrix);
    return status == FIBRAD_OK ? fibrad_matrix_read(matrix, &factors) : status;
}

int main() {
    const std::vector<double> x{0, 2, 0}, y{0, 0, 2}, z{0, 0, 0.5}, r{1, 1, 0.8};
    fibrad_spheres spheres{};
    spheres.x = x.data(), spheres.y = y.data(), spheres.z = z.data(), spheres.r = r.data();
    spheres.n = static_cast<std::uint32_t>(r.size());
    std::vector<unsigned char> memory;
    fibrad_factors f{};
    const int status = view_factors(spheres, memory, f);
    if (status != FIBRAD_OK) return std::fprintf(stderr, "%s\n", fibrad_status_text(status)), 1;
    for (std::uint32_t i = 0; i < f.n; i++)
        for (auto k = f.start[i]; k < f.start[i + 1]; k++)
            std::printf("F %u -> %u  %.5f\n", unsigned(i), unsigned(f.col[k]), f.f[k]);
    return 0;
}
