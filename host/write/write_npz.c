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

/* Writes numbers in so many bytes each, the lowest first. */
struct little {
    uint64_t value;
    int bytes;
};

static void put_all(FILE *file, const struct little *fields, size_t n) {
    for (size_t k = 0; k < n; ++k)
        for (int byte = 0; byte < fields[k].bytes; ++byte) putc((int)(fields[k].value >> 8 * byte & 255), file);
}

#define PUT(file, ...)                                                                                                 \
    put_all(file, (const struct little[]){__VA_ARGS__},                                                                \
            sizeof(const struct little[]){__VA_ARGS__} / sizeof(struct little))

static void make_header(const struct array *array, unsigned char header[HEADER]) {
    static const char magic[] = "\x93NUMPY\1";
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1, bytes = array->type[0] == 'S' || array->type[1] == '1';
    const char order = bytes ? '|' : little ? '<' : '>';
    char text[HEADER], shape[48] = "";
    if (array->length != SCALAR && array->columns > 0)
        snprintf(shape, sizeof shape, "%" PRIu64 ", %" PRIu64, array->length, array->columns);
    else if (array->length != SCALAR)
        snprintf(shape, sizeof shape, "%" PRIu64 ",", array->length);
    const int used = snprintf(text, sizeof text, "{'descr': '%c%s', 'fortran_order': False, 'shape': (%s), }", order,
                              array->type, shape);
    memset(header, ' ', HEADER);
    memcpy(header, magic, sizeof magic);
    header[8] = HEADER - 10;
    header[9] = 0;
    memcpy(header + 10, text, (size_t)used);
    header[HEADER - 1] = '\n';
}

/* Writes the header of a member (entry false) or its entry in the directory: version that reads ZIP64, flags, stored,
 * time and date (1 January 1980, so that equal matrices make equal files), checksum, both sizes (they are in the ZIP64
 * field), lengths of the name and of the ZIP64 field. An entry also has comment, disk, attributes, and the offset,
 * which is in the ZIP64 field, too. Returns the number of bytes. */
static uint64_t put_header(FILE *file, const struct member *member, bool entry) {
    const uint64_t size = HEADER + member->bytes, name = strlen(member->array.name);
    PUT(file, {entry ? 0x02014b50 : 0x04034b50, 4});
    if (entry) PUT(file, {45, 2});
    PUT(file, {45, 2}, {0, 2}, {0, 2}, {0x00210000, 4}, {member->crc, 4}, {UINT32_MAX, 4}, {UINT32_MAX, 4}, {name, 2},
        {entry ? 28 : 20, 2});
    if (entry) PUT(file, {0, 2}, {0, 2}, {0, 2}, {0, 4}, {UINT32_MAX, 4});
    fputs(member->array.name, file);
    PUT(file, {1, 2}, {entry ? 24 : 16, 2}, {size, 8}, {size, 8});
    if (entry) PUT(file, {member->offset, 8});
    return name + (entry ? 46 + 28 : 30 + 20);
}

/* Writes the data of a member; file NULL: adds them to the checksum. */
static int pass_data(FILE *file, struct member *member) {
    const unsigned char *data = member->array.data;
    for (uint64_t done = 0; done < member->bytes; done += BLOCK) {
        const uint64_t left = member->bytes - done, size = left < BLOCK ? left : BLOCK;
        if (interrupt_status()) return interrupt_status();
        if (file)
            fwrite(data + done, size, 1, file); /* the caller checks the file */
        else
            member->crc = (uint32_t)crc32_z(member->crc, data + done, size);
    }
    return STATUS_OK;
}

static int write_member(FILE *file, struct member *member, uint64_t *offset) {
    unsigned char header[HEADER];
    make_header(&member->array, header);
    member->offset = *offset;
    member->crc = (uint32_t)crc32_z(0, header, HEADER);
    const int status = pass_data(NULL, member);
    if (status) return status;
    *offset += put_header(file, member, false) + HEADER + member->bytes;
    fwrite(header, 1, HEADER, file);
    return pass_data(file, member);
}

/* Writes the end of the directory in ZIP64, where it is, and the old form with all bits set, which refers to ZIP64. */
static void put_end(FILE *file, uint64_t members, uint64_t offset, uint64_t size) {
    PUT(file, {0x06064b50, 4}, {44, 8}, {45, 2}, {45, 2}, {0, 8}, {members, 8}, {members, 8}, {size, 8}, {offset, 8});
    PUT(file, {0x07064b50, 4}, {0, 4}, {offset + size, 8}, {1, 4});
    PUT(file, {0x06054b50, 4}, {0, 4}, {members, 2}, {members, 2}, {UINT32_MAX, 4}, {UINT32_MAX, 4}, {0, 2});
}

/* The members of an archive, and memory of arrays that are made for it. */
struct arrays {
    struct member list[ARRAYS_MAX];
    size_t count;
    int64_t *position;
    double (*x)[3];
};

/* Adds an array unless it has no data or an array of its name is there. */
static void add_array(struct arrays *arrays, struct array array) {
    const uint64_t each = strtoull(array.type + 1, NULL, 10), columns = array.columns > 0 ? array.columns : 1;
    for (size_t k = 0; k < arrays->count; ++k)
        if (strcmp(arrays->list[k].array.name, array.name) == 0) return;
    if ((array.data || array.length == 0) && arrays->count < ARRAYS_MAX)
        arrays->list[arrays->count++] =
            (struct member){.array = array, .bytes = each * (array.length == SCALAR ? 1 : array.length * columns)};
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

static int write_archive(FILE *file, struct arrays *arrays) {
    uint64_t offset = 0, directory = 0;
    for (size_t k = 0; k < arrays->count; ++k) {
        const int status = write_member(file, &arrays->list[k], &offset);
        if (status) return status;
    }
    for (size_t k = 0; k < arrays->count; ++k) directory += put_header(file, &arrays->list[k], true);
    put_end(file, arrays->count, offset, directory);
    return STATUS_OK;
}

int write_npz(FILE *file, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    const uint64_t n = matrix->n, entries = matrix->start[n];
    const int64_t shape[2] = {matrix->n, matrix->n};
    struct arrays arrays = {.count = 0};
    char names[WALLS_MAX * WALL_NAME];
    add_array(&arrays, (struct array){"indices.npy", "i4", matrix->col, entries, 0});
    add_array(&arrays, (struct array){"indptr.npy", "i8", matrix->start, n + 1, 0});
    add_array(&arrays, (struct array){"format.npy", "S3", "csr", SCALAR, 0});
    add_array(&arrays, (struct array){"shape.npy", "i8", shape, 2, 0});
    add_array(&arrays, (struct array){"data.npy", "f8", matrix->f, entries, 0});
    for (size_t k = 0; k < what->arrays; ++k) add_array(&arrays, what->array[k]);
    int status = add_spheres(&arrays, what->bed);
    if (!status) add_rows(&arrays, what, names);
    if (!status) status = write_archive(file, &arrays);
    free(arrays.position);
    free(arrays.x);
    return status;
}
