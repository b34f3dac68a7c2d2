/* read_foreign.c - recognises files without spheres that people give by mistake, and says what they are.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "read/read_format.h"

#define TEXT_DUMP "write a text dump: dump ... custom ... id x y z radius"

/* Files known by bytes at their beginning. */
static const struct {
    size_t at;
    const char *bytes, *what;
} magics[] = {
    {0, "\x89HDF", "an HDF5 file; export the spheres as text"},
    {0, "\x93NUMPY", "a NumPy array; write it by savetxt(..., header='x y z r')"},
    {0, "PK\x03\x04", "a zip archive, as .npz and .xlsx are; export the spheres as CSV"},
    {0, "BZh", "packed by bzip2; try: bzcat FILE | fibrad factors -"},
    {0, "\3757zX", "packed by xz; try: xzcat FILE | fibrad factors -"},
    {0, "\x28\xb5\x2f\xfd", "packed by zstd; try: zstdcat FILE | fibrad factors -"},
    {0, "\xdf\x65\xdf\x65", "a GSD file of HOOMD-blue; export the spheres as extended XYZ"},
    {0, "\xff\xfe", "text in UTF-16; save it as UTF-8"},
    {0, "\xfe\xff", "text in UTF-16; save it as UTF-8"},
    {0, "LammpS RestartT", "a LAMMPS restart file; write a text dump or a data file"},
    {8, "DUMP", "a binary LAMMPS dump; write a text dump"},
    {4, "CORD", "a DCD file; " TEXT_DUMP},
    {0, "---\n", "a dump in YAML, as dump yaml of LAMMPS writes it; " TEXT_DUMP},
    {0, "Number of particles", "an AtomEye .cfg file; " TEXT_DUMP},
    {0, "{", "JSON; export the spheres as CSV"},
    {0, "<", "XML without spheres that fibrad can read"},
    {0, "ply\n", "a PLY file of surfaces"},
    {0, "solid ", "an STL file of surfaces"},
    {0, "%%MatrixMarket", "a matrix, as fibrad writes it; give the file of the spheres"},
    {0, "FIBROWS1", "a file of rows; put them together: fibrad join FILE..."},
};

/* Tables that fibrad writes, known by columns of the header. Columns of frames and files may stand before them. */
static const struct {
    const char *columns, *what;
} own[] = {
    {"i,j,F", "view factors, as fibrad factors writes them; give the file of the spheres"},
    {"i,j,D", "exchange factors, as fibrad factors writes them; give the file of the spheres"},
    {"i,T_K,q_W",
     "powers, as fibrad heat writes them, without centres of spheres; give the file of the spheres, or write .dump"},
    {"axis,F_E,", "conductivities, as fibrad conductivity writes them; give the file of the spheres"},
};

/* Whether a text, which ends at `end`, begins with another one. */
static bool begins(const char *text, const char *end, const char *with) {
    return (size_t)(end - text) >= strlen(with) && memcmp(text, with, strlen(with)) == 0;
}

static const char *find_kind(const char *text, size_t size) {
    const char *end = text + size, *line = memchr(text, '\n', size);
    for (size_t k = 0; k < sizeof magics / sizeof *magics; ++k)
        if (size >= magics[k].at && begins(text + magics[k].at, end, magics[k].bytes)) return magics[k].what;
    for (size_t k = 0; k < sizeof own / sizeof *own; ++k)
        for (const char *at = text; at < (line ? line : end); ++at)
            if ((at == text || at[-1] == ',') && begins(at, end, own[k].columns)) return own[k].what;
    return NULL;
}

int source_foreign(const struct source *source) {
    size_t size;
    const char *text = source_begin(source, &size), *kind = find_kind(text, size);
    return kind ? message_at(STATUS_INPUT, source->lines.name, 0, "this is %s", kind) : STATUS_OK;
}
