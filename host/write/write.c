/* write.c - finds the writer of a matrix for the ending of a file. SPDX-License-Identifier: MIT */
#include "write/write.h"

#include "cli/output.h"

write_function *write_find(const char *path, const char **endings) {
    static const struct {
        const char *ending;
        write_function *write;
    } writers[] = {{".csv", write_csv}, {".mtx", write_mtx}, {".npz", write_npz}, {".vtp", write_vtp}};
    if (endings) *endings = ".csv, .mtx, .npz and .vtp";
    for (size_t k = 0; k < sizeof writers / sizeof *writers; ++k)
        if (output_ends(path, writers[k].ending)) return writers[k].write;
    return NULL;
}
