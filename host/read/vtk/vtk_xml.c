/* vtk_xml.c - points and arrays of VTK's XML files, .vtp and .vtu, and of .pvtp, .pvtu and .vtm, whose pieces are such
 * files. SPDX-License-Identifier: MIT
 *
 * An array is text or base64 in the tag that declares the array. Or the array is appended: it stands at an offset in
 * the last tag of the file, as base64 or bytes. Binary data begin with the number of bytes, or with a list of blocks
 * that zlib has packed.
 */
#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "cli/message.h"
#include "text/read_number.h"
#include "read/vtk/vtk_grid.h"

enum { WORD = XML_WORD, WIDEST = 8, PACKED_MOST = 1100 }; /* zlib packs to no less than 1/1032 */

struct xml {
    struct vtk_grid *grid;
    const char *at;
    const char *appended;    /* first byte of appended arrays; NULL: there are none */
    bool raw;                /* appended arrays are bytes, not base64 */
    bool big;                /* big-endian */
    bool packed;             /* blocks are packed by zlib */
    bool points, point_data; /* within the tag Points, PointData */
    struct vtk_type header;  /* type of the numbers of bytes */
    bool within;             /* within a piece */
    bool parallel;           /* the pieces are other files */
    uint64_t all;            /* points of all pieces so far */
};

/* Type, length and place of an array. */
struct place {
    struct vtk_type type;
    uint64_t count;
    const char *at;
    bool text, raw;
};

#define xml_fail(xml, ...) vtk_fail((xml)->grid, (xml)->at, __VA_ARGS__)

bool vtk_next_set(const char **text, char time[XML_WORD], char file[XML_WORD]) {
    const char *set = strstr(*text, "<DataSet");
    if (!set) return false;
    const struct xml_tag tag = {set, set + strcspn(set, ">")};
    xml_attribute(&tag, "timestep", time);
    xml_attribute(&tag, "file", file);
    *text = tag.end;
    return true;
}

static uint64_t number_of(const struct xml_tag *tag, const char *name, uint64_t otherwise) {
    char value[WORD];
    int64_t number;
    return number_read_whole(xml_attribute(tag, name, value), &number) && number >= 0 ? (uint64_t)number : otherwise;
}

/* ---- bytes ------------------------------------------------------------------------------------------------------ */

/* A stream of bytes, from base64 or from bytes (raw). */
struct stream {
    const char *at, *end;
    bool raw;
    unsigned char ready[3];
    int left; /* bytes of `ready` that are left */
};

static int sextet(char c) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c ? strchr(digits, c) : NULL;
    return found ? (int)(found - digits) : -1;
}

/* Decodes four digits of base64 into three bytes, or into fewer if there is padding. */
static bool decode(struct stream *stream) {
    uint32_t bits = 0;
    int digits = 0;
    for (int k = 0; k < 4; ++k) {
        while (stream->at < stream->end && isspace((unsigned char)*stream->at)) ++stream->at;
        if (stream->at == stream->end) return false;
        const char c = *stream->at++;
        const int value = c == '=' ? 0 : sextet(c);
        if (value < 0 || (c != '=' && digits < k)) return false;
        digits += c != '=';
        bits = bits << 6 | (uint32_t)value;
    }
    stream->left = digits - 1;
    for (int k = 0; k < stream->left; ++k) stream->ready[stream->left - 1 - k] = (unsigned char)(bits >> (16 - 8 * k));
    return stream->left > 0;
}

static bool take_bytes(struct stream *stream, void *to, uint64_t size) {
    if (stream->raw) {
        if (size > (uint64_t)(stream->end - stream->at)) return false;
        memcpy(to, stream->at, (size_t)size);
        stream->at += size;
        return true;
    }
    for (unsigned char *byte = to; size > 0; --size) {
        if (stream->left == 0 && !decode(stream)) return false;
        *byte++ = stream->ready[--stream->left];
    }
    return true;
}

static bool take_size(const struct xml *xml, struct stream *stream, uint64_t *size) {
    unsigned char bytes[WIDEST];
    double value;
    if (!take_bytes(stream, bytes, xml->header.size)) return false;
    vtk_convert(xml->header, xml->big, bytes, 1, &value);
    *size = value < 9e15 ? (uint64_t)value : UINT64_MAX;
    return true;
}

static int take_plain(const struct xml *xml, struct stream *stream, unsigned char *to, uint64_t bytes) {
    uint64_t size;
    if (!take_size(xml, stream, &size) || size != bytes || !take_bytes(stream, to, bytes))
        return xml_fail(xml, "an array is damaged or has the wrong size");
    return STATUS_OK;
}

/* Reads packed data: number of blocks, size of a block, size of the last block if it is smaller, packed size of each
 * block, and the blocks. */
static int take_packed(const struct xml *xml, struct stream *stream, unsigned char *to, uint64_t bytes) {
    const uint64_t most = (uint64_t)(xml->grid->end - xml->grid->text);
    uint64_t blocks, size, last;
    if (!take_size(xml, stream, &blocks) || !take_size(xml, stream, &size) || !take_size(xml, stream, &last) ||
        blocks > most / xml->header.size || (blocks > 0 && (size == 0 || blocks - 1 > bytes / size)))
        return xml_fail(xml, "the blocks of an array are damaged");
    uint64_t *packed = malloc((size_t)(blocks + 1) * sizeof *packed);
    unsigned char *from = malloc((size_t)most + 1);
    int status = packed && from ? STATUS_OK : message_memory();
    bool good = !status;
    for (uint64_t k = 0; k < blocks && good; ++k) good = take_size(xml, stream, &packed[k]) && packed[k] <= most;
    stream->left = 0;
    uint64_t done = 0;
    for (uint64_t k = 0; k < blocks && good; ++k) {
        uLongf got = (uLongf)(bytes - done);
        good = take_bytes(stream, from, packed[k]) && uncompress(to + done, &got, from, (uLong)packed[k]) == Z_OK;
        if (good) done += got;
    }
    if (!status && (!good || done != bytes)) status = xml_fail(xml, "the blocks of an array are damaged");
    free(packed);
    free(from);
    return status;
}

static int take_values(struct xml *xml, const struct place *place, double **values) {
    const uint64_t most = (uint64_t)(xml->grid->end - xml->grid->text), bytes = place->count * place->type.size;
    if (bytes / (place->text ? WIDEST : xml->packed ? PACKED_MOST : 1) > most)
        return xml_fail(xml, "an array is longer than the file");
    int status = vtk_room(values, place->count);
    if (status) return status;
    if (place->text) {
        const char *at = place->at;
        return vtk_scan(&at, xml->grid->end, place->count, *values) ? STATUS_OK
                                                                    : xml_fail(xml, "an array is too short");
    }
    double *data = NULL; /* holds bytes */
    struct stream stream = {.at = place->at, .end = xml->grid->end, .raw = place->raw};
    status = vtk_room(&data, bytes / sizeof *data + 1);
    if (!status) status = (xml->packed ? take_packed : take_plain)(xml, &stream, (unsigned char *)data, bytes);
    if (!status) vtk_convert(place->type, xml->big, data, place->count, *values);
    free(data);
    return status;
}

/* ---- tags ------------------------------------------------------------------------------------------------------- */

static int xml_file(struct xml *xml, const struct xml_tag *tag) {
    char value[WORD];
    xml_attribute(tag, "type", value);
    xml->parallel = strcmp(value, "PPolyData") == 0 || strcmp(value, "PUnstructuredGrid") == 0 ||
                    strcmp(value, "vtkMultiBlockDataSet") == 0;
    if (xml->parallel && !xml->grid->open) return xml_fail(xml, "pieces of pieces have no points, but pieces");
    if (!xml->parallel && strcmp(value, "PolyData") != 0 && strcmp(value, "UnstructuredGrid") != 0)
        return vtk_fail(xml->grid, NULL, "this is a VTK file of type %.40s: it has no spheres", value);
    xml->big = strcmp(xml_attribute(tag, "byte_order", value), "BigEndian") == 0;
    if (*xml_attribute(tag, "header_type", value)) xml->header = vtk_find_type(value);
    if (xml->header.kind != 'u') return xml_fail(xml, "the header_type is not known");
    xml_attribute(tag, "compressor", value);
    xml->packed = *value != 0;
    if (xml->packed && strcmp(value, "vtkZLibDataCompressor") != 0)
        return xml_fail(xml, "its arrays are packed by %.40s; only arrays packed by zlib can be read", value);
    return STATUS_OK;
}

/* Ends the piece before, and begins another one. */
static int take_piece(struct xml *xml, const struct xml_tag *tag) {
    const uint64_t n = number_of(tag, "NumberOfPoints", 0), most = (uint64_t)(xml->grid->end - xml->grid->text);
    char source[WORD];
    const int status = xml->within ? vtk_end_piece(xml->grid) : STATUS_OK;
    xml->within = !xml->parallel;
    if (status) return status;
    if (xml->parallel) {
        if (!*xml_attribute(tag, "Source", source)) return xml_fail(xml, "a piece has no Source");
        return xml->grid->open(source, xml->grid->context);
    }
    if (n > UINT32_MAX) return xml_fail(xml, "too many points");
    xml->all += n;
    if (xml->all / (xml->packed ? PACKED_MOST : 1) > most)
        return xml_fail(xml, "pieces have more points than the file");
    xml->grid->n = n;
    return STATUS_OK;
}

static int xml_array(struct xml *xml, const struct xml_tag *tag) {
    char name[WORD], format[WORD], type[WORD];
    const uint64_t components = number_of(tag, "NumberOfComponents", 1);
    xml_attribute(tag, "Name", name);
    xml_attribute(tag, "format", format);
    double *values = NULL;
    if (xml->grid->n == 0 || !(xml->points || vtk_wants(xml->grid, name))) return STATUS_OK;
    if (components != (xml->points ? 3 : 1))
        return xml_fail(xml, "the array %.40s has %" PRIu64 " components", name, components);
    struct place place = {.type = vtk_find_type(xml_attribute(tag, "type", type)), .count = components * xml->grid->n};
    place.at = xml->at, place.text = strcmp(format, "ascii") == 0;
    if (place.type.size == 0) return xml_fail(xml, "arrays of type %.40s cannot be read", type);
    if (strcmp(format, "appended") == 0) {
        const uint64_t offset = number_of(tag, "offset", UINT64_MAX);
        if (!xml->appended || offset > (uint64_t)(xml->grid->end - xml->appended))
            return xml_fail(xml, "the array has no data");
        place.at = xml->appended + offset;
        place.raw = xml->raw;
    }
    if (xml->points) return take_values(xml, &place, &xml->grid->points);
    const int status = take_values(xml, &place, &values);
    if (!status) return vtk_give(xml->grid, name, values);
    free(values);
    return status;
}

static int xml_tag(struct xml *xml, const struct xml_tag *tag) {
    char file[WORD];
    if (xml_is(tag, "VTKFile")) return xml_file(xml, tag);
    if (xml_is(tag, "Piece")) return take_piece(xml, tag);
    if (xml_is(tag, "DataSet") && xml->parallel &&
        *xml_attribute(tag, "file", file)) /* a block without a file is empty */
        return xml->grid->open(file, xml->grid->context);
    if (!xml->within) return STATUS_OK;
    if (xml_is(tag, "DataArray") && (xml->points || xml->point_data)) return xml_array(xml, tag);
    const bool begins = *tag->text != '/' && tag->end[-1] != '/';
    const struct xml_tag rest = {tag->text + (*tag->text == '/'), tag->end};
    if (xml_is(&rest, "Points")) xml->points = begins;
    if (xml_is(&rest, "PointData")) xml->point_data = begins;
    return STATUS_OK;
}

/* Finds the appended arrays, which begin behind the first _ after the tag AppendedData. */
static void find_appended(struct xml *xml) {
    static const char name[] = "<AppendedData";
    struct xml_tag tag;
    char encoding[WORD];
    const char *from = xml->at;
    const size_t length = strlen(name);
    while ((from = memchr(from, '<', (size_t)(xml->grid->end - from)))) {
        if ((size_t)(xml->grid->end - from) > length && memcmp(from, name, length) == 0) break;
        ++from;
    }
    if (!from) return;
    struct xml behind = *xml;
    behind.at = from;
    if (!xml_next(&behind.at, xml->grid->end, &tag)) return;
    const char *mark = memchr(behind.at, '_', (size_t)(xml->grid->end - behind.at));
    xml->raw = strcmp(xml_attribute(&tag, "encoding", encoding), "raw") == 0;
    xml->appended = mark ? mark + 1 : NULL;
}

int vtk_read_xml(struct vtk_grid *grid) {
    struct xml xml = {.grid = grid, .at = grid->text, .header = vtk_find_type("UInt32")};
    struct xml_tag tag;
    find_appended(&xml);
    while (xml_next(&xml.at, grid->end, &tag) && !xml_is(&tag, "AppendedData")) {
        const int status = xml_tag(&xml, &tag);
        if (status) return status;
    }
    return xml.within ? vtk_end_piece(grid) : STATUS_OK;
}
