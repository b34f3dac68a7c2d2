/* write_npz.c - a matrix as a NumPy archive that scipy.sparse.load_npz opens. SPDX-License-Identifier: MIT
 *
 * The file is a ZIP archive without compression. It has a member for each array of the matrix in compressed rows. A
 * member is a header of 128 bytes, which names type and shape, and the array as it is in memory. All members have
 * 64-bit sizes (ZIP64), so that small and large files are written alike. The checksum stands before the data, so it is
 * computed first. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/write.h"

enum { HEADER = 128, BLOCK = 1 << 20 };

#define SCALAR UINT64_MAX /* length of an array without dimensions */

struct member {
    struct array array;
    uint64_t bytes;  /* of data */
    uint64_t offset; /* where in the file the member begins */
    uint32_t crc;
};

/* Writes a number in `bytes` bytes, the lowest first. */
static void put_little(FILE *file, uint64_t value, int bytes) {
    for (; bytes > 0; --bytes, value >>= 8) putc((int)(value & 255), file);
}

static void make_header(const struct member *member, unsigned char header[HEADER]) {
    static const char magic[] = "\x93NUMPY\1";
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1;
    const bool bytes = member->array.type[0] == 'S' || member->array.type[1] == '1';
    const char order = bytes ? '|' : little ? '<' : '>';
    char text[HEADER];
    char shape[48] = "";
    const struct array *array = &member->array;
    if (array->length != SCALAR && array->columns > 0)
        snprintf(shape, sizeof shape, "%" PRIu64 ", %" PRIu64, array->length, array->columns);
    else if (array->length != SCALAR)
        snprintf(shape, sizeof shape, "%" PRIu64 ",", array->length);
    const int used = snprintf(text, sizeof text, "{'descr': '%c%s', 'fortran_order': False, 'shape': (%s), }", order,
                              member->array.type, shape);
    memset(header, ' ', HEADER);
    memcpy(header, magic, sizeof magic);
    header[8] = HEADER - 10;
    header[9] = 0;
    memcpy(header + 10, text, (size_t)used);
    header[HEADER - 1] = '\n';
}

/* Writes the fields that are the same in local and central headers, from the version to the length of the name. */
static void put_common(FILE *file, const struct member *member) {
    put_little(file, 45, 2);         /* version that reads ZIP64 */
    put_little(file, 0, 2);          /* flags */
    put_little(file, 0, 2);          /* stored */
    put_little(file, 0x00210000, 4); /* time and date: 1 January 1980, so that equal matrices make equal files */
    put_little(file, member->crc, 4);
    put_little(file, UINT32_MAX, 4); /* both sizes are in the ZIP64 field */
    put_little(file, UINT32_MAX, 4);
    put_little(file, strlen(member->array.name), 2);
}

static void put_sizes(FILE *file, const struct member *member, uint64_t field) {
    put_little(file, 1, 2); /* the ZIP64 field */
    put_little(file, field, 2);
    put_little(file, HEADER + member->bytes, 8);
    put_little(file, HEADER + member->bytes, 8);
}

static int write_member(FILE *file, struct member *member) {
    unsigned char header[HEADER];
    make_header(member, header);
    uLong crc = crc32_z(0, header, HEADER);
    const unsigned char *data = member->array.data;
    for (uint64_t done = 0; done < member->bytes; done += BLOCK) {
        if (interrupt_status()) return interrupt_status();
        const uint64_t left = member->bytes - done;
        crc = crc32_z(crc, data + done, left < BLOCK ? left : BLOCK);
    }
    member->crc = (uint32_t)crc;
    put_little(file, 0x04034b50, 4);
    put_common(file, member);
    put_little(file, 20, 2);
    fputs(member->array.name, file);
    put_sizes(file, member, 16);
    fwrite(header, 1, HEADER, file);
    for (uint64_t done = 0; done < member->bytes; done += BLOCK) {
        if (interrupt_status()) return interrupt_status();
        const uint64_t left = member->bytes - done;
        if (!fwrite(data + done, left < BLOCK ? left : BLOCK, 1, file)) break; /* the caller checks the file */
    }
    return STATUS_OK;
}

/* Bytes of a member, and of its entry in the directory. */
static uint64_t member_size(const struct member *member) {
    return 30 + strlen(member->array.name) + 20 + HEADER + member->bytes;
}

static uint64_t entry_size(const struct member *member) { return 46 + strlen(member->array.name) + 28; }

static void put_entry(FILE *file, const struct member *member) {
    put_little(file, 0x02014b50, 4);
    put_little(file, 45, 2);
    put_common(file, member);
    put_little(file, 28, 2);
    put_little(file, 0, 2);          /* comment */
    put_little(file, 0, 2);          /* disk */
    put_little(file, 0, 2);          /* internal attributes */
    put_little(file, 0, 4);          /* external attributes */
    put_little(file, UINT32_MAX, 4); /* the offset is in the ZIP64 field, too */
    fputs(member->array.name, file);
    put_sizes(file, member, 24);
    put_little(file, member->offset, 8);
}

/* Writes the end of the directory in ZIP64, and the old form with all bits set, which refers to ZIP64. */
static void put_end(FILE *file, uint64_t members, uint64_t offset, uint64_t size) {
    put_little(file, 0x06064b50, 4);
    put_little(file, 44, 8);
    put_little(file, 45, 2);
    put_little(file, 45, 2);
    put_little(file, 0, 8); /* disks */
    put_little(file, members, 8);
    put_little(file, members, 8);
    put_little(file, size, 8);
    put_little(file, offset, 8);

    put_little(file, 0x07064b50, 4);
    put_little(file, 0, 4);
    put_little(file, offset + size, 8);
    put_little(file, 1, 4); /* disks in all */

    put_little(file, 0x06054b50, 4);
    put_little(file, 0, 4); /* disks */
    put_little(file, members, 2);
    put_little(file, members, 2);
    put_little(file, UINT32_MAX, 4);
    put_little(file, UINT32_MAX, 4);
    put_little(file, 0, 2); /* comment */
}

static struct member make_member(const struct array *array) {
    const uint64_t each = strtoull(array->type + 1, NULL, 10), columns = array->columns > 0 ? array->columns : 1;
    return (struct member){.array = *array, .bytes = array->length == SCALAR ? each : each * array->length * columns};
}

/* The arrays of an archive, and memory of arrays that are made for it. */
struct arrays {
    struct array list[ARRAYS_MAX];
    size_t count;
    int64_t *position;
    double (*x)[3];
};

/* Adds an array unless it has no data or an array of its name is there. */
static void add_array(struct arrays *arrays, struct array array) {
    for (size_t k = 0; k < arrays->count; ++k)
        if (strcmp(arrays->list[k].name, array.name) == 0) return;
    if (array.data && arrays->count < ARRAYS_MAX) arrays->list[arrays->count++] = array;
}

static int add_spheres(struct arrays *arrays, const struct bed *bed) {
    const uint64_t n = bed->n;
    arrays->position = malloc(n * sizeof *arrays->position + 1);
    arrays->x = malloc(n * sizeof *arrays->x + 1);
    if (!arrays->position || !arrays->x) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i) {
        arrays->position[i] = bed_name(bed, i);
        arrays->x[i][0] = bed->x[i], arrays->x[i][1] = bed->y[i], arrays->x[i][2] = bed->z[i];
    }
    add_array(arrays, (struct array){"ids.npy", "i8", arrays->position, n, 0});
    add_array(arrays, (struct array){"x.npy", "f8", arrays->x, n, 3});
    add_array(arrays, (struct array){"radius.npy", "f8", bed->r, n, 0});
    add_array(arrays, (struct array){"length_unit.npy", "S16", bed->units, SCALAR, 0});
    return STATUS_OK;
}

/* The array of names of walls. Each takes 8 bytes, or WALL_NAME bytes if a name is longer. */
static struct array wall_names(const struct contents *what, char names[WALLS_MAX * WALL_NAME]) {
    const uint32_t walls = what->walls->count;
    char name[WALL_NAME];
    size_t width = 8;
    for (uint32_t k = 0; k < walls; ++k)
        if (strlen(contents_wall(what, k, name)) > width) width = WALL_NAME;
    for (uint32_t k = 0; k < walls; ++k) strncpy(names + k * width, contents_wall(what, k, name), width);
    return (struct array){"wall_names.npy", width > 8 ? "S32" : "S8", names, walls, 0};
}

/* Adds the arrays of rows besides the matrix. */
static void add_rows(struct arrays *arrays, const struct contents *what, char names[WALLS_MAX * WALL_NAME]) {
    const fibrad_factors *matrix = &what->factors->matrix;
    const uint64_t n = matrix->n;
    const uint32_t walls = what->walls ? what->walls->count : 0;
    add_array(arrays, (struct array){"escaped.npy", "f8", matrix->escaped, n, 0});
    add_array(arrays, (struct array){"beyond.npy", "f8", matrix->beyond, n, 0});
    add_array(arrays, (struct array){"error.npy", "f8", matrix->error, n, 0});
    add_array(arrays, (struct array){"computed.npy", "u1", what->wanted, n, 0});
    if (what->grey) add_array(arrays, (struct array){"emissivity.npy", "f8", what->grey->emissivity, n, 0});
    if (what->grey && what->grey->node_emissivity)
        add_array(arrays, (struct array){"node_emissivity.npy", "f8", what->grey->node_emissivity, n, 0});
    if (walls == 0) return;
    add_array(arrays, (struct array){"body.npy", "f8", matrix->wall, n, walls});
    add_array(arrays, wall_names(what, names));
    if (!matrix->wall_wall) return;
    add_array(arrays, (struct array){"wall_area.npy", "f8", what->factors->wall_area, walls, 0});
    add_array(arrays, (struct array){"wall_wall.npy", "f8", matrix->wall_wall, walls, walls});
    add_array(arrays, (struct array){"wall_escaped.npy", "f8", matrix->wall_escaped, walls, 0});
    add_array(arrays, (struct array){"wall_error.npy", "f8", matrix->wall_error, walls, 0});
}

static int write_archive(FILE *file, const struct arrays *arrays) {
    struct member members[ARRAYS_MAX];
    uint64_t offset = 0, directory = 0;
    for (size_t k = 0; k < arrays->count; ++k) {
        members[k] = make_member(&arrays->list[k]);
        members[k].offset = offset;
        const int status = write_member(file, &members[k]);
        if (status) return status;
        offset += member_size(&members[k]);
    }
    for (size_t k = 0; k < arrays->count; ++k) {
        put_entry(file, &members[k]);
        directory += entry_size(&members[k]);
    }
    put_end(file, arrays->count, offset, directory);
    return STATUS_OK;
}

int write_npz(FILE *file, const struct contents *what, bool first) {
    const fibrad_factors *matrix = &what->factors->matrix;
    const uint64_t n = matrix->n, entries = matrix->start[n];
    const int64_t shape[2] = {matrix->n, matrix->n};
    struct arrays arrays = {.list = {{"indices.npy", "i4", matrix->col, entries, 0},
                                     {"indptr.npy", "i8", matrix->start, n + 1, 0},
                                     {"format.npy", "S3", "csr", SCALAR, 0},
                                     {"shape.npy", "i8", shape, 2, 0},
                                     {"data.npy", "f8", matrix->f, entries, 0}},
                            .count = 5};
    char names[WALLS_MAX * WALL_NAME];
    (void)first;
    for (size_t k = 0; k < what->arrays; ++k) add_array(&arrays, what->array[k]);
    int status = add_spheres(&arrays, what->bed);
    if (!status) add_rows(&arrays, what, names);
    if (!status) status = write_archive(file, &arrays);
    free(arrays.position);
    free(arrays.x);
    return status;
}
