/* read_foreign.c - recognises files without spheres, and says what they are. SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <string.h>

#include "read/read_format.h"

/* Files known by bytes at their beginning. */
static const struct {
    size_t at;
    const char *bytes, *what;
} magics[] = {
    {0, "\x89PNG", "a PNG picture"},
    {0, "\xff\xd8\xff", "a JPEG picture"},
    {0, "%PDF", "a PDF document"},
    {0, "\x89HDF", "an HDF5 file; export the spheres as text"},
    {0, "CDF", "a NetCDF file; write a text dump"},
    {0, "\x93NUMPY", "a NumPy array; write it by savetxt(..., header='x y z r')"},
    {0, "PK\x03\x04", "a zip archive, as .npz and .xlsx are; export the spheres as CSV"},
    {0, "BZh", "packed by bzip2; try: bzcat FILE | fibrad factors -"},
    {0, "\3757zX", "packed by xz; try: xzcat FILE | fibrad factors -"},
    {0, "\x28\xb5\x2f\xfd", "packed by zstd; try: zstdcat FILE | fibrad factors -"},
    {0, "\177ELF", "a program"},
    {0, "MATLAB", "a MATLAB file; export the spheres as CSV"},
    {0, "SQLite", "a SQLite database; export the spheres as CSV"},
    {0, "\xdf\x65\xdf\x65", "a GSD file of HOOMD-blue; export the spheres as extended XYZ"},
    {0, "\xff\xfe", "text in UTF-16; save it as UTF-8"},
    {0, "\xfe\xff", "text in UTF-16; save it as UTF-8"},
    {0, "LammpS RestartT", "a LAMMPS restart file; write a text dump or a data file"},
    {8, "DUMP", "a binary LAMMPS dump; write a text dump"},
    {4, "CORD", "a DCD file; write a text dump: dump ... custom ... id x y z radius"},
    {0, "ply\n", "a PLY file of surfaces"},
    {0, "solid ", "an STL file of surfaces"},
    {0, "%%MatrixMarket", "a matrix, as fibrad writes it; give the file of the spheres"},
    {0, "FIBROWS1", "a file of rows; put them together: fibrad join FILE..."},
};

static const char mdpa[] =
    "an .mdpa file of Kratos, which has nodes and radii in different tables; write a table with a header: id,x,y,z,r";

/* Files known by their first text behind blanks and comments //. */
static const struct {
    const char *text, *what;
} texts[] = {
    {"{", "JSON; export the spheres as CSV"},
    {"<", "XML without spheres that fibrad can read"},
    {"#!/", "a script"},
    {"import ", "a Python program"},
    {"from ", "a Python program"},
    {"---\n",
     "a dump in YAML, as dump yaml of LAMMPS writes it; write a text dump: dump ... custom ... id x y z radius"},
    {"Begin ModelPartData", mdpa},
    {"Begin Properties", mdpa},
    {"Begin Nodes", mdpa},
    {"Number of particles", "an AtomEye .cfg file; write a text dump: dump ... custom ... id x y z radius"},
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

/* Commands with which LAMMPS input scripts begin. */
static const char *const commands[] = {"units",       "atom_style",     "boundary",   "variable", "dimension", "newton",
                                       "atom_modify", "processors",     "package",    "shell",    "log",       "echo",
                                       "clear",       "region",         "read_data",  "include",  "print",     "if",
                                       "label",       "hard_particles", "communicate"};

/* Whether a text, which ends at `end`, begins with another one. */
static bool begins(const char *text, const char *end, const char *with) {
    return (size_t)(end - text) >= strlen(with) && memcmp(text, with, strlen(with)) == 0;
}

/* Skips blanks, and comments that begin with a mark. */
static const char *skip_comments(const char *text, const char *end, const char *mark) {
    for (;;) {
        while (text < end && isspace((unsigned char)*text)) ++text;
        const char *next = begins(text, end, mark) ? memchr(text, '\n', (size_t)(end - text)) : NULL;
        if (!next) return text;
        text = next;
    }
}

/* Whether the first word behind comments is a command of LAMMPS with an argument. */
static bool is_script(const char *text, const char *end) {
    text = skip_comments(text, end, "#");
    for (size_t k = 0; k < sizeof commands / sizeof *commands; ++k) {
        if (!begins(text, end, commands[k])) continue;
        const char *behind = text + strlen(commands[k]);
        if (behind < end && strchr(" \t", *behind)) return true;
    }
    return false;
}

/* Looks in the first line for a table that fibrad writes. NULL: it is none. */
static const char *find_own(const char *text, const char *end) {
    const char *line = memchr(text, '\n', (size_t)(end - text));
    for (size_t k = 0; k < sizeof own / sizeof *own; ++k)
        for (const char *at = text; at < (line ? line : end); ++at)
            if ((at == text || at[-1] == ',') && begins(at, end, own[k].columns)) return own[k].what;
    return NULL;
}

static const char *find_kind(const char *text, size_t size) {
    const char *end = text + size;
    for (size_t k = 0; k < sizeof magics / sizeof *magics; ++k)
        if (size >= magics[k].at && begins(text + magics[k].at, end, magics[k].bytes)) return magics[k].what;
    if (is_script(text, end)) return "an input script of LAMMPS; give a dump or data file";
    const char *written = find_own(text, end);
    if (written) return written;
    text = skip_comments(text, end, "//");
    for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k)
        if (begins(text, end, texts[k].text)) return texts[k].what;
    return NULL;
}

int source_foreign(const struct source *source) {
    size_t size;
    const char *text = source_begin(source, &size), *kind = find_kind(text, size);
    return kind ? message_at(STATUS_INPUT, source->lines.name, 0, "this is %s", kind) : STATUS_OK;
}
