/* pencils.c - how the beams of a sphere are kept. SPDX-License-Identifier: MIT
 *
 * The beams of a row are sorted by what they meet, about a hundred bodies. So the end of a beam is a patch of a known
 * body, which takes one byte. All beams that were followed tell how much two bodies exchange. Those that are kept tell
 * where on the bodies light leaves and arrives. Each of them stands for an equal number of beams. */
#include "patches/subdivision.h"
#include "patches/pencils.h"
#include "pair/free_pair.h"

/* Number of bodies that a row sees, times the solid fraction, over the square root of its beams. Measured in random
 * beds of equal spheres: 0.75 at the solid fraction 0.6, and 1.1 at 0.2. */
#define ROOM_PENCILS 1.3

/* Let N beams connect spheres of P patches. They make N/8 strands and ROOM_STRANDS sqrt(N P) more, and ROOM_BUNDLES
 * sqrt(N P/4) bundles. Measured at solid fractions from 1/2 on, for N from 1,000 to 50,000: 2.9 to 3.9 and 1.6 to 2.8
 * up to P = 96, 4.8 and 4 at P = 384. */
#define ROOM_STRANDS      4.5
#define ROOM_BUNDLES      3.4
#define ROOM_STRANDS_WIDE 6.8
#define ROOM_BUNDLES_WIDE 5.0

#define ROOM_NODE 200.0 /* bytes of the rays of a fine four; there are fewer fine fours than nodes */

/* About how many strands or bundles are left when beams are joined. `most` holds at solid fractions from 1/2 on. */
static double room_joined(double beams, double most, double fraction) {
    return fibrad_min(beams, most + (beams - most) * fibrad_max(0, 1 - 2 * fraction));
}

/* Room for beams to spheres that no window has met. */
#define FREE_BEAMS 256u

struct heat_pool {
    size_t links_at, bytes; /* SIZE_MAX: more than a size_t can say */
};

/* Lays out a pool: the bytes of all pencils, then the links. */
static struct heat_pool pool_of(size_t pencil_bytes, size_t links) {
    fibrad_arena arena = {0};
    struct heat_pool pool;
    fibrad_arena_take(&arena, pencil_bytes, 1);
    pool.links_at = arena.used;
    fibrad_arena_take(&arena, links, sizeof(fibrad_heat_link));
    pool.bytes = arena.used;
    return pool;
}

/* Whether there is room for what is kept so far. */
static bool pool_suffices(fibrad_heat *heat) {
    const size_t links = fibrad_add_at_once(&heat->pencils.links, 0);
    return pool_of(fibrad_add_at_once(&heat->pencils.used, 0), links).bytes <= heat->pencils.room;
}

static size_t whole_of(double number) { return number < (double)(SIZE_MAX / 2) ? (size_t)number : SIZE_MAX; }

/* All beams that meet walls are kept. By reciprocity their number is in proportion to the area of the walls. */
size_t fibrad_heat_room(const fibrad_heat *heat) {
    const fibrad_scene *scene = heat->scene;
    const double n = heat->spheres, beams = heat->beams, spacing = scene->spacing;
    double solid = 0, surface = 0, walls = 0;
    if (heat->spheres == 0) return 0;
    for (uint32_t i = 0; i < heat->spheres; i++) {
        const double r = scene->r[i];
        solid += 4. / 3 * FIBRAD_PI * r * r * r, surface += 4 * FIBRAD_PI * r * r;
    }
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        if (scene->wall_area[k] > 0) walls += fibrad_heat_wall_area(heat, k);
    for (uint32_t m = 0; m < heat->meshes; m++) walls += fibrad_mesh_area(&scene->mesh, m);
    const double others = 2 * FIBRAD_WALLS + heat->meshes + 2;
    const double blocks = others + (heat->patches - n * heat->config.patches) / FIBRAD_HEAT_BLOCK;
    const double fraction = fibrad_min(1, solid / (n * spacing * spacing * spacing));
    const double pencils = fibrad_min(fibrad_min(n + blocks, beams), 16 + ROOM_PENCILS * fibrad_sqrt(beams) / fraction);
    const double of_walls = walls > 0 ? beams * fibrad_min(1, 1.5 * walls / surface) : 0;
    const double thinned = beams / heat->thin, pairs = thinned * heat->config.patches;
    const bool wide = heat->config.patches > FIBRAD_HEAT_BLOCK;
    const double most_strands = (wide ? ROOM_STRANDS_WIDE : ROOM_STRANDS) * fibrad_sqrt(pairs);
    const double most_bundles = (wide ? ROOM_BUNDLES_WIDE : ROOM_BUNDLES) * fibrad_sqrt(pairs / FIBRAD_HEAT_FOUR);
    const double more = pencils + of_walls;
    const double strands = room_joined(thinned, most_strands + thinned / FIBRAD_HEAT_STRAND, fraction) + more;
    const double bundles = room_joined(thinned, most_bundles, fraction) + more;
    const double all = pencils + strands / FIBRAD_HEAT_STRANDS;
    const double bytes = sizeof(fibrad_heat_bundle) * bundles + strands + all * (sizeof(fibrad_heat_pencil) + 2);
    const double of_fine = heat->division.nodes_capacity > 1 ? ROOM_NODE * heat->division.nodes_capacity : 0;
    return pool_of(whole_of(1.1 * n * bytes + of_fine + 4096), whole_of(1.1 * n * all)).bytes;
}

/* Beams of an entry from one four to another: their number for each pair of patches, and a bit for each pair that has
 * any. */
#define PAIRS (FIBRAD_HEAT_FOUR * FIBRAD_HEAT_FOUR)
struct four_patches {
    uint16_t from, to;
    uint32_t some, count[PAIRS];
};

/* A pencil that is being written, its place in memory, and the number of pencils written before. */
struct pencil_draft {
    fibrad_heat_pencil pencil;
    fibrad_heat_bundle bundle[FIBRAD_HEAT_STRANDS];
    uint8_t strand[FIBRAD_HEAT_STRANDS];
    unsigned char *to;
    uint32_t written;
};

/* The parts of work->extra that a row uses. */
struct row_scratch {
    fibrad_heat_beam *beam, *sorted;
    unsigned char *pencils;
    struct four_patches *fours;
    uint16_t *seen; /* index in `fours` of each pair of fours, counted from 1 */
};

/* The largest number of fours at the other end of a beam. */
static uint32_t fours_stride(const fibrad_heat *heat) {
    const uint32_t most = heat->division.nodes_capacity > 1 ? FIBRAD_HEAT_PATCHES_MAX : heat->config.patches;
    return (most > FIBRAD_HEAT_BLOCK ? most : FIBRAD_HEAT_BLOCK) / FIBRAD_HEAT_FOUR;
}

/* The largest number of pairs of fours at both ends. */
static size_t fours_pairs(const fibrad_heat *heat) {
    const uint32_t most = heat->division.nodes_capacity > 1 ? FIBRAD_HEAT_PATCHES_MAX : heat->config.patches;
    return (size_t)(most / FIBRAD_HEAT_FOUR) * fours_stride(heat);
}

/* The largest number of bytes of a beam, which has a pencil, a bundle and a strand of its own. */
#define BEAM_BYTES (sizeof(fibrad_heat_pencil) + sizeof(fibrad_heat_bundle) + 1)

/* Sorts beams by their entries. counts: out: [entries] number of the beams of each entry and all before it. */
static void sort_beams(const fibrad_heat_beam *beam, uint32_t count, fibrad_heat_beam *sorted, uint64_t *counts,
                       uint32_t entries) {
    uint64_t sum = 0;
    for (uint32_t e = 0; e < entries; e++) counts[e] = 0;
    for (uint32_t k = 0; k < count; k++) counts[beam[k].entry]++;
    for (uint32_t e = 0; e < entries; e++) sum += counts[e], counts[e] = sum - counts[e];
    for (uint32_t k = 0; k < count; k++) sorted[counts[beam[k].entry]++] = beam[k];
}

/* Joins the beams of an entry that connect the same two fours. Returns the number of such pairs. They are in the order
 * of their first beam. `seen` is zero before and after. */
static uint32_t join_beams(const fibrad_heat *heat, const fibrad_heat_beam *beam, uint64_t count,
                           const struct row_scratch *scratch) {
    const uint32_t stride = fours_stride(heat);
    struct four_patches *fours = scratch->fours;
    uint32_t joined = 0;
    for (uint64_t k = 0; k < count; k++) {
        const uint32_t from = beam[k].from / FIBRAD_HEAT_FOUR, to = beam[k].to / FIBRAD_HEAT_FOUR;
        const uint32_t pair = beam[k].from % FIBRAD_HEAT_FOUR * FIBRAD_HEAT_FOUR + beam[k].to % FIBRAD_HEAT_FOUR;
        uint16_t *at = &scratch->seen[from * stride + to];
        if (*at == 0) {
            fours[joined] = (struct four_patches){(uint16_t)from, (uint16_t)to, 0, {0}};
            *at = (uint16_t)++joined;
        }
        fours[*at - 1].some |= 1u << pair;
        fours[*at - 1].count[pair]++;
    }
    for (uint32_t k = 0; k < joined; k++) scratch->seen[fours[k].from * stride + fours[k].to] = 0;
    return joined;
}

/* Writes the pencil if it has beams, and begins another one. */
static void write_pencil(struct pencil_draft *draft) {
    fibrad_heat_pencil *pencil = &draft->pencil;
    const size_t bytes = pencil->bundles * sizeof *draft->bundle;
    if (pencil->strands == 0) return;
    fibrad_copy(draft->to, pencil, sizeof *pencil);
    fibrad_copy(draft->to + sizeof *pencil, draft->bundle, bytes);
    fibrad_copy(draft->to + sizeof *pencil + bytes, draft->strand, pencil->strands);
    draft->to += fibrad_heat_pencil_bytes(pencil);
    draft->written++;
    pencil->bundles = pencil->strands = 0;
}

/* Adds the beams between two fours as a bundle. If they are too many for one bundle, it adds several. */
static void write_bundle(struct pencil_draft *draft, const struct four_patches *fours) {
    fibrad_heat_pencil *pencil = &draft->pencil;
    fibrad_heat_bundle *bundle = NULL;
    for (uint32_t some = fours->some; some != 0; some &= some - 1) {
        const uint32_t pair = (uint32_t)__builtin_ctz(some);
        for (uint32_t left = fours->count[pair], beams; left > 0; left -= beams) {
            beams = left < FIBRAD_HEAT_STRAND ? left : FIBRAD_HEAT_STRAND;
            if (pencil->strands == FIBRAD_HEAT_STRANDS) write_pencil(draft), bundle = NULL;
            if (bundle == NULL || bundle->count + beams > UINT8_MAX) {
                if (pencil->strands > 0) draft->strand[pencil->strands - 1] |= FIBRAD_HEAT_LAST;
                bundle = &draft->bundle[pencil->bundles++];
                *bundle = (fibrad_heat_bundle){(uint8_t)fours->from, (uint8_t)fours->to, 0};
            }
            draft->strand[pencil->strands++] = (uint8_t)(pair * FIBRAD_HEAT_STRAND + beams - 1);
            bundle->count = (uint8_t)(bundle->count + beams);
        }
    }
}

/* Writes the pencils of a row, one for each entry. An entry with too many strands has several. Returns the number of
 * pencils that end on rows of other parts. */
static uint32_t write_row(const fibrad_heat *heat, uint32_t place, const fibrad_entries *entries,
                          const struct row_scratch *scratch, size_t *bytes) {
    struct pencil_draft draft = {.to = scratch->pencils};
    const double weight = place < heat->spheres ? 1 : FIBRAD_HEAT_RAY;
    uint64_t begin = 0;
    uint32_t links = 0;
    for (uint32_t e = 0; e < entries->length; begin = entries->key[0][e++]) {
        if (entries->key[0][e] == begin) continue; /* triangles hide this sphere */
        const double *part = entries->part[e], even = part[0] + part[2], odd = part[1] + part[3];
        const double tilt = fibrad_max(-1, fibrad_min(1, (even - odd) / (even + odd)));
        const uint64_t beams = entries->key[0][e] - begin;
        const uint32_t body = entries->sphere[e], joined = join_beams(heat, scratch->sorted + begin, beams, scratch);
        draft.pencil = (fibrad_heat_pencil){
            .body = body, .weight = (float)(weight * (even + odd) / (double)beams), .tilt = (int16_t)(32767 * tilt)};
        draft.written = 0;
        for (uint32_t k = 0; k < joined; k++) write_bundle(&draft, &scratch->fours[k]);
        write_pencil(&draft);
        if (body < heat->rows && !fibrad_heat_same_part(heat, place, body)) links += draft.written;
    }
    *bytes = (size_t)(draft.to - scratch->pencils);
    return links;
}

/* Bytes of the arrays of row_scratch, which follow each other: both arrays of beams, pencils, fours, seen. */
static void scratch_bytes(const fibrad_heat *heat, size_t bytes[4]) {
    const size_t beams = (size_t)heat->beams + FREE_BEAMS, pairs = fours_pairs(heat);
    bytes[0] = 2 * beams * sizeof(fibrad_heat_beam);
    bytes[1] = beams * BEAM_BYTES;
    bytes[2] = (pairs < beams ? pairs : beams) * sizeof(struct four_patches);
    bytes[3] = pairs * sizeof(uint16_t);
}

size_t fibrad_heat_scratch(const fibrad_heat *heat) {
    size_t bytes[4];
    scratch_bytes(heat, bytes);
    return bytes[0] + bytes[1] + bytes[2] + bytes[3];
}

static struct row_scratch divide_scratch(const fibrad_heat *heat, unsigned char *memory) {
    size_t bytes[4];
    scratch_bytes(heat, bytes);
    unsigned char *const pencils = memory + bytes[0], *const fours = pencils + bytes[1];
    return (struct row_scratch){.beam = (void *)memory,
                                .sorted = (void *)(memory + bytes[0] / 2),
                                .pencils = pencils,
                                .fours = (void *)fours,
                                .seen = (void *)(fours + bytes[2])};
}

/* A beam along the line of centres to the sphere of an entry. */
static fibrad_heat_beam beam_along_centres(const fibrad_heat *heat, const fibrad_workspace *work, uint32_t entry) {
    const uint32_t other = work->entries.sphere[entry];
    double out[3] = {heat->scene->x[other], heat->scene->y[other], heat->scene->z[other]}, back[3], square = 0;
    for (int axis = 0; axis < 3; axis++) out[axis] -= work->centre[axis], square += out[axis] * out[axis];
    for (int axis = 0; axis < 3; axis++) out[axis] /= fibrad_sqrt(square), back[axis] = -out[axis];
    return (fibrad_heat_beam){entry, (uint16_t)fibrad_patch_of(out, heat->side),
                              (uint16_t)fibrad_patch_of(back, heat->side)};
}

/* What a row has of free pairs and of all that is no sphere, in beams. */
struct free_share {
    double others[4], seen[4]; /* by part of an entry */
    bool left_out;             /* a sphere that no beam meets has lost its exact factor */
    uint64_t exact;            /* sum of exact factors, in units of 2^-60, so that it does not depend on an order */
};

static double beams_in_parts(const double part[4]) { return part[0] + part[2] + (part[1] + part[3]); }

/* Sums up a row. Spheres with fine patches have no exact factor, and neither have members of the same clump, nor
 * spheres for whose beams there is no room. */
static struct free_share share_of_free(const fibrad_heat *heat, uint32_t place, fibrad_entries *entries) {
    struct free_share share = {.exact = 0};
    uint32_t more = 0;
    for (uint32_t k = 0; k < entries->length; k++) {
        const double *part = entries->part[k];
        const bool unmet = beams_in_parts(part) == 0;
        for (int p = 0; p < 4 && entries->sphere[k] >= heat->rows; p++) share.others[p] += part[p];
        if (!(entries->exact[k] > 0)) continue;
        const bool inside = fibrad_one_clump(heat->scene, place, entries->sphere[k]);
        if (inside || heat->division.root[entries->sphere[k]] != FIBRAD_NONE || (unmet && ++more > FREE_BEAMS)) {
            entries->exact[k] = 0, share.left_out = share.left_out || unmet;
            continue;
        }
        for (int p = 0; p < 4; p++) share.seen[p] += part[p];
        share.exact += (uint64_t)(entries->exact[k] * 0x1p60);
    }
    return share;
}

/* Gives the entry of a free pair its exact factor, `exact` in beams; all parts are equal. */
static void take_exact(double part[4], double exact) {
    for (int p = 0; p < 4; p++) part[p] = exact / 4;
}

/* Scales an entry that is no sphere. Its sum changes by a ratio that is the same for all such entries. Each part of all
 * of them together takes what free pairs have moved in this part, so that the parts differ as the errors that remain.
 */
static void take_rest(double part[4], const struct free_share *share, double exact, double others, double left) {
    const double ratio = left / others, sum = beams_in_parts(part);
    for (int p = 0; p < 4; p++) {
        const double of_part = share->others[p] + share->seen[p] - exact / 4;
        part[p] = ratio * part[p] + sum / others * (of_part - ratio * share->others[p]);
    }
}

uint32_t fibrad_heat_free_beams(fibrad_heat *heat, fibrad_workspace *work, uint32_t count) {
    fibrad_heat_beam *beam = work->extra;
    fibrad_entries *entries = &work->entries;
    const double all = heat->beams;
    heat->pencils.row[work->place].complete = false;
    if (heat->division.root[work->place] != FIBRAD_NONE) return count;
    const fibrad_free_pairs pairs = fibrad_free_pairs_find(work, 1 / all, false);
    const struct free_share share = share_of_free(heat, work->place, entries);
    const double exact = (double)share.exact * 0x1p-60 * all, others = beams_in_parts(share.others);
    const double left = others + (beams_in_parts(share.seen) - exact);
    heat->pencils.row[work->place].complete = pairs.told && !share.left_out && (share.exact == 0 || left > 0);
    if (share.exact == 0 || !(left > 0)) return count;
    for (uint32_t k = 0; k < entries->length; k++) {
        double *part = entries->part[k];
        if (entries->exact[k] > 0) {
            if (beams_in_parts(part) == 0) beam[count++] = beam_along_centres(heat, work, k);
            take_exact(part, entries->exact[k] * all);
        } else if (entries->sphere[k] >= heat->rows) {
            take_rest(part, &share, exact, others, left);
        }
    }
    return count;
}

int fibrad_heat_keep(fibrad_heat *heat, const fibrad_workspace *work, uint32_t place, uint32_t count) {
    const fibrad_entries *entries = &work->entries;
    fibrad_heat_row *row = &heat->pencils.row[place];
    if (!pool_suffices(heat)) return FIBRAD_E_SIZE; /* from the first row without room on, all rows fail */
    const struct row_scratch scratch = divide_scratch(heat, work->extra);
    sort_beams(scratch.beam, count, scratch.sorted, entries->key[0], entries->length);
    fibrad_zero(scratch.seen, fours_pairs(heat) * sizeof *scratch.seen);
    const uint32_t more = write_row(heat, place, entries, &scratch, &row->bytes);
    row->begin = fibrad_add_at_once(&heat->pencils.used, row->bytes);
    fibrad_add_at_once(&heat->pencils.links, more);
    /* if threads add at once, the last one sees the sum of all */
    if (!pool_suffices(heat)) return FIBRAD_E_SIZE;
    fibrad_copy(heat->pencils.pool + row->begin, scratch.pencils, row->bytes);
    return FIBRAD_OK;
}

void fibrad_heat_link_pencils(fibrad_heat *heat) {
    const uint32_t n = heat->rows;
    size_t *first = heat->pencils.first_link;
    fibrad_zero(first, (n + 2) * sizeof *first);
    heat->pencils.link = (void *)(heat->pencils.pool + pool_of(heat->pencils.used, heat->pencils.links).links_at);
    for (int pass = 0; pass < 2; pass++) { /* links are counted first */
        for (uint32_t place = 0; place < n; place++) {
            const unsigned char *begin = heat->pencils.pool + heat->pencils.row[place].begin,
                                *end = begin + heat->pencils.row[place].bytes;
            for (const unsigned char *at = begin; at < end; at += fibrad_heat_pencil_bytes(fibrad_heat_pencil_at(at))) {
                const uint32_t other = fibrad_heat_pencil_at(at)->body;
                if (other >= n || fibrad_heat_same_part(heat, place, other)) continue;
                if (pass == 0)
                    first[other + 2]++;
                else
                    heat->pencils.link[first[other + 1]++] = (fibrad_heat_link){place, (uint32_t)((at - begin) / 4)};
            }
        }
        for (uint32_t i = 2; i < n + 2 && pass == 0; i++) first[i] += first[i - 1];
    }
}
