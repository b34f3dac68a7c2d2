/* sweep.c - net flows between patches, by a sweep over all beams. SPDX-License-Identifier: MIT
 *
 * A beam brings one end what it takes from the other. So flows add up to zero whatever patches send. They are zero if
 * all patches send the same.
 *
 * The spheres are divided into parts. The sweep of a part changes only the sums of its own spheres. A beam between two
 * spheres of one part is visited once and serves both ends. A beam between two parts is visited by both, and each
 * serves its own end. */
#include "heat/sweep.h"
#include "heat/errors.h"

#define AHEAD  8
#define BEYOND (FIBRAD_WALLS + 1)

/* The area that a beam of a pencil stands for. If its two surfaces send out n and m beams per area, this is 1/(n + m).
 * So the beams of both together tell what they exchange, or beams and rays of a mesh. The weight is the number of beams
 * that were followed for each beam that was kept. In the sweep for the error, the weight is the difference between even
 * and odd directions instead. */
static double beam_area(const fibrad_heat *heat, uint32_t owner, const fibrad_heat_pencil *pencil) {
    const double other =
        pencil->body < heat->rows ? heat->density[pencil->body] : fibrad_heat_seeing(heat, pencil->body, owner);
    const double check = pencil->tilt / 32767. * (owner < heat->spheres ? 1 : FIBRAD_HEAT_RAYS_WEIGHT);
    const double weight = heat->solution.phase == FIBRAD_HEAT_CHECK ? pencil->weight * check : pencil->weight;
    return weight / (heat->density[owner] + other);
}

/* What both ends of a pencil send, and the sums of what each end receives. The owner is the row that has the pencil. */
struct pencil_ends {
    const double *owner, *other;
    double *to_owner, *to_other;
    const double *back_owner, *back_other; /* of fibrad_heat_enlarged; NULL: 0 */
    double area;                           /* of a beam */
};

/* Adds the flow of each strand to one end and takes it from the other end. areas: the sums are areas, so the flow is
 * added to both ends. enlarged: an end may be a patch that sends back all. */
FIBRAD_INLINE void bring_strands(const fibrad_heat_pencil *pencil, const struct pencil_ends *ends, bool areas,
                                 bool enlarged) {
    const fibrad_heat_bundle *bundle = fibrad_heat_bundles(pencil);
    const uint8_t *strand = fibrad_heat_strands(pencil), *end = strand + pencil->strands;
    const double *mine = ends->owner, *other = ends->other;
    double *own = ends->to_owner, *theirs = ends->to_other, all[FIBRAD_HEAT_STRAND];
    for (uint32_t k = 0; k < FIBRAD_HEAT_STRAND; k++) all[k] = (k + 1) * ends->area;
    for (; strand < end; strand++) {
        const uint32_t bits = *strand, a = FIBRAD_HEAT_FOUR * bundle->from + (bits >> 5 & 3),
                       b = FIBRAD_HEAT_FOUR * bundle->to + (bits >> 3 & 3);
        double area = all[bits & 7];
        if (enlarged)
            area =
                fibrad_heat_enlarged(area, FIBRAD_HEAT_BEAMS_RETURN, ends->back_owner != NULL ? ends->back_owner[a] : 0,
                                     ends->back_other != NULL ? ends->back_other[b] : 0);
        const double flow = area * (other[b] - mine[a]);
        own[a] += flow;
        theirs[b] += areas ? flow : -flow;
        bundle += bits >> 7;
    }
}

/* The same if all patches of a four send the same. The first patch of each four gathers for all four. */
static void bring_bundles(const fibrad_heat_pencil *pencil, const struct pencil_ends *ends) {
    const fibrad_heat_bundle *bundle = fibrad_heat_bundles(pencil);
    for (uint32_t k = 0; k < pencil->bundles; k++) {
        const uint32_t a = FIBRAD_HEAT_FOUR * bundle[k].from, b = FIBRAD_HEAT_FOUR * bundle[k].to;
        const double flow = ends->area * bundle[k].count * (ends->other[b] - ends->owner[a]);
        ends->to_owner[a] += flow;
        ends->to_other[b] -= flow;
    }
}

/* The first patch of the other end of a pencil. */
static size_t other_end(const fibrad_heat *heat, const fibrad_heat_pencil *pencil) {
    const uint32_t body = pencil->body;
    return body < heat->rows ? fibrad_heat_first_of_row(heat, body) : fibrad_heat_other_block(heat, body);
}

/* Many beams meet the few patches of the surroundings and beyond endless walls. One sum of all their flows would lose
 * digits. So short sums are moved into long ones again and again. */
static void set_aside(const fibrad_heat *heat, double *to, double sum[BEYOND]) {
    const uint32_t first = heat->first[fibrad_heat_beyond(heat, 0)], others = fibrad_heat_others(heat);
    for (uint32_t b = first; b < heat->patches; b++) sum[b - first] += to[b - others], to[b - others] = 0;
}

/* What the sweep of a part works with. */
struct gathering {
    bool areas;          /* the sums are areas */
    bool coarse;         /* patches of a four send the same */
    bool back;           /* some patches send back all that arrives */
    double *walls;       /* what patches receive that are not of spheres */
    double away[BEYOND]; /* long sums of set_aside */
    double none[FIBRAD_HEAT_PATCHES_MAX],
        one[FIBRAD_HEAT_PATCHES_MAX];      /* what both ends send if sums are areas: 0, 1 */
    double waste[FIBRAD_HEAT_PATCHES_MAX]; /* sums of ends that other parts gather for */
};

/* `back` of the patches from `first` on. NULL: none sends back all. */
static const double *back_from(const fibrad_heat *heat, size_t first, const struct gathering *g) {
    return g->back && first >= fibrad_heat_others(heat) ? heat->solution.back + (first - fibrad_heat_others(heat))
                                                        : NULL;
}

/* Adds the flows of a pencil to the sums of both ends. */
static void bring_ends(const fibrad_heat *heat, uint32_t owner, const fibrad_heat_pencil *pencil, double *to_owner,
                       double *to_other, const struct gathering *g) {
    const struct pencil_ends ends = {
        .owner = g->areas ? g->none : heat->solution.source + fibrad_heat_first_of_row(heat, owner),
        .other = g->areas ? g->one : heat->solution.source + other_end(heat, pencil),
        .to_owner = to_owner,
        .to_other = to_other,
        .back_owner = back_from(heat, fibrad_heat_first_of_row(heat, owner), g),
        .back_other = back_from(heat, other_end(heat, pencil), g),
        .area = beam_area(heat, owner, pencil),
    };
    if (g->coarse && pencil->body < heat->rows)
        bring_bundles(pencil, &ends);
    else if (g->areas)
        bring_strands(pencil, &ends, true, false);
    else if (ends.back_owner != NULL || ends.back_other != NULL)
        bring_strands(pencil, &ends, false, true);
    else
        bring_strands(pencil, &ends, false, false);
}

/* The reflectivity of the other end of a pencil. */
static double reflectivity_of(const fibrad_heat *heat, const fibrad_heat_pencil *pencil) {
    return fibrad_heat_sent_back(heat, pencil->body < heat->rows ? fibrad_heat_body_of_row(heat, pencil->body)
                                                                 : fibrad_heat_other_body(heat, pencil->body));
}

/* Adds the beams that meet another sphere, and the square of the difference between even and odd ones. */
static void note_sphere(fibrad_heat_seen *seen, const fibrad_heat_pencil *pencil, double beams) {
    const double tilt = pencil->tilt / 32767., square = beams * tilt * (beams * tilt);
    seen->met += beams, seen->squares += square;
    if (tilt == 1 || tilt == -1) seen->one_parity += square;
}

/* The flow to the surroundings of a pencil whose other end is not a sphere. */
static double escaping_flow(const fibrad_heat *heat, uint32_t owner, const fibrad_heat_pencil *pencil) {
    const double outside = fibrad_heat_outside(heat, fibrad_heat_other_body(heat, pencil->body));
    const double *mine = heat->solution.source + fibrad_heat_first_of_row(heat, owner);
    const double *other = heat->solution.source + fibrad_heat_other_block(heat, pencil->body);
    const fibrad_heat_bundle *bundle = fibrad_heat_bundles(pencil);
    const uint8_t *strand = fibrad_heat_strands(pencil), *end = strand + pencil->strands;
    double flow = 0;
    for (; strand < end && outside > 0; strand++) {
        const uint32_t a = FIBRAD_HEAT_FOUR * bundle->from, b = FIBRAD_HEAT_FOUR * bundle->to + (*strand >> 3 & 3);
        flow += ((*strand & 7) + 1) * (mine[a] - other[b]);
        bundle += *strand >> 7;
    }
    return outside > 0 ? outside * beam_area(heat, owner, pencil) * flow : 0;
}

/* Adds to heat->samples what a pencil tells about the sphere that it leaves. */
static void note_pencil(const fibrad_heat *heat, uint32_t row, const fibrad_heat_pencil *pencil) {
    const uint32_t body = fibrad_heat_body_of_row(heat, row);
    const bool other = pencil->body >= heat->rows;
    if (body >= heat->spheres) return;
    if (other) heat->samples.seen[body].escaping += escaping_flow(heat, row, pencil);
    if (row != body) return;
    const double beams = fibrad_heat_beams_of(pencil);
    heat->samples.seen[body].reflected[other] += reflectivity_of(heat, pencil) * beams;
    if (pencil->body < heat->spheres) note_sphere(&heat->samples.seen[body], pencil, beams);
}

/* The sums of a row. A row of fine fours of a wall has them among those of walls. */
static double *gathered_by(const fibrad_heat *heat, uint32_t row, const struct gathering *g) {
    const uint32_t first = fibrad_heat_first_of_row(heat, row), others = fibrad_heat_others(heat);
    return first < others ? heat->solution.gathered + first : g->walls + (first - others);
}

static void sweep_own_beams(const fibrad_heat *heat, uint32_t place, double *own, struct gathering *g) {
    const unsigned char *at = heat->pencils.pool + heat->pencils.row[place].begin,
                        *end = at + heat->pencils.row[place].bytes;
    while (at < end) {
        const fibrad_heat_pencil *pencil = fibrad_heat_pencil_at(at);
        if (pencil->body >= heat->rows) {
            double *walls = g->walls + (other_end(heat, pencil) - fibrad_heat_others(heat));
            bring_ends(heat, place, pencil, own, walls, g);
            set_aside(heat, g->walls, g->away);
        } else {
            const bool both = fibrad_heat_same_part(heat, place, pencil->body);
            bring_ends(heat, place, pencil, own, both ? gathered_by(heat, pencil->body, g) : g->waste, g);
        }
        if (heat->solution.phase == FIBRAD_HEAT_CHECK) note_pencil(heat, place, pencil);
        at += fibrad_heat_pencil_bytes(pencil);
    }
}

static void sweep_beams_of_others(const fibrad_heat *heat, uint32_t place, double *own, struct gathering *g) {
    for (size_t l = heat->pencils.first_link[place]; l < heat->pencils.first_link[place + 1]; l++) {
        if (l + AHEAD < heat->pencils.first_link[place + 1]) {
            const fibrad_heat_link *next = &heat->pencils.link[l + AHEAD];
            const unsigned char *soon =
                heat->pencils.pool + heat->pencils.row[next->sphere].begin + 4 * (size_t)next->at;
            __builtin_prefetch(soon);
            __builtin_prefetch(soon + 64);
        }
        const uint32_t owner = heat->pencils.link[l].sphere;
        const unsigned char *row = heat->pencils.pool + heat->pencils.row[owner].begin;
        bring_ends(heat, owner, fibrad_heat_pencil_at(row + 4 * (size_t)heat->pencils.link[l].at), g->waste, own, g);
    }
}

static void sweep_row(const fibrad_heat *heat, uint32_t row, struct gathering *g) {
    sweep_own_beams(heat, row, gathered_by(heat, row, g), g);
    sweep_beams_of_others(heat, row, gathered_by(heat, row, g), g);
}

/* Sweeps the spheres and the rows of fine fours of a part. */
static void sweep_rows(const fibrad_heat *heat, uint32_t part, struct gathering *g) {
    const uint32_t n = heat->spheres, *place = heat->sequence, begin = fibrad_heat_part_begin(heat, n, part),
                   end = fibrad_heat_part_begin(heat, n, part + 1);
    for (uint32_t k = begin; k < end; k++) {
        fibrad_zero(gathered_by(heat, place[k], g), heat->config.patches * sizeof(double));
        heat->samples.seen[place[k]] = (fibrad_heat_seen){{0, 0}, 0, 0, 0, 0, 0};
    }
    for (uint32_t row = n; row < heat->rows; row++)
        if (heat->part[row] == part)
            fibrad_zero(gathered_by(heat, row, g),
                        FIBRAD_HEAT_FOUR * heat->division.fine[row - n].count * sizeof(double));
    for (uint32_t k = begin; k < end; k++) sweep_row(heat, place[k], g);
    for (uint32_t row = n; row < heat->rows; row++)
        if (heat->part[row] == part) sweep_row(heat, row, g);
}

static void sweep_rays(const fibrad_heat *heat, uint32_t begin, uint32_t end, struct gathering *g) {
    const double *source = heat->solution.source;
    const uint32_t others = fibrad_heat_others(heat);
    for (uint32_t k = begin; k < end; k++) {
        const fibrad_heat_ray ray = heat->ray[k];
        if (ray.area == 0 || ray.to < others) continue;
        const double area = g->back ? fibrad_heat_ray_area(heat, &ray) : ray.area;
        const double flow = g->areas ? area : area * (source[ray.to] - source[ray.from]);
        g->walls[ray.from - others] += flow;
        g->walls[ray.to - others] += g->areas ? flow : -flow;
        if (k % 64 == 63) set_aside(heat, g->walls, g->away);
    }
}

/* Sweeps the rays that meet spheres of a part. In the sweep for the error, spheres take the difference between even
 * and odd rays. */
static void sweep_met(const fibrad_heat *heat, uint32_t part, struct gathering *g) {
    const double *source = heat->solution.source;
    for (uint32_t l = heat->first_met[part]; l < heat->first_met[part + 1]; l++) {
        const uint32_t k = heat->met[l];
        const fibrad_heat_ray ray = heat->ray[k];
        const double area = g->back ? fibrad_heat_ray_area(heat, &ray) : ray.area;
        const double flow = g->areas ? area : area * (source[ray.to] - source[ray.from]);
        if (heat->solution.phase == FIBRAD_HEAT_CHECK) {
            heat->samples.seen[fibrad_heat_sphere_of(heat, ray.to)].rays += flow * flow;
            heat->solution.gathered[ray.to] -= FIBRAD_HEAT_RAYS_WEIGHT * (k % 2 ? -flow : flow);
            continue;
        }
        g->walls[ray.from - fibrad_heat_others(heat)] += flow;
        heat->solution.gathered[ray.to] += g->areas ? flow : -flow;
    }
}

/* Sweeps the rows and the rays of a part. */
static void sweep_part(fibrad_heat *heat, uint32_t part) {
    const uint32_t others = fibrad_heat_others(heat), of_walls = heat->patches - others;
    const bool areas = heat->solution.phase == FIBRAD_HEAT_AREA;
    const bool coarse = heat->solution.phase == FIBRAD_HEAT_CHECK || (heat->solution.group > 1 && !areas);
    const bool back = !areas && heat->solution.phase != FIBRAD_HEAT_CHECK && heat->solution.sends_back;
    struct gathering g = {areas, coarse, back, heat->solution.brought + (size_t)part * of_walls, {0}, {0}, {0}, {0}};
    for (uint32_t a = 0; a < FIBRAD_HEAT_PATCHES_MAX; a++) g.one[a] = 1;
    fibrad_zero(g.walls, of_walls * sizeof *g.walls);
    sweep_rows(heat, part, &g);
    sweep_met(heat, part, &g);
    if (heat->solution.phase == FIBRAD_HEAT_CHECK && heat->sources.conducts && !heat->solution.steps)
        fibrad_heat_find_extremes(heat, fibrad_heat_part_begin(heat, heat->spheres, part),
                                  fibrad_heat_part_begin(heat, heat->spheres, part + 1), &heat->near[part]);
    if (heat->solution.phase != FIBRAD_HEAT_CHECK) /* result.c finds the errors of rays wall by wall */
        sweep_rays(heat, fibrad_heat_part_begin(heat, heat->rays, part),
                   fibrad_heat_part_begin(heat, heat->rays, part + 1), &g);
    set_aside(heat, g.walls, g.away);
    const uint32_t few = heat->first[fibrad_heat_beyond(heat, 0)];
    fibrad_copy(g.walls + (few - others), g.away, (heat->patches - few) * sizeof *g.walls);
}

int fibrad_heat_sweep(fibrad_heat *heat, uint32_t part) {
    if (heat == NULL || part >= heat->config.parts) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase == FIBRAD_HEAT_IDLE || heat->solution.phase == FIBRAD_HEAT_DONE || heat->swept[part])
        return FIBRAD_E_STATE;
    sweep_part(heat, part);
    heat->swept[part] = 1;
    return FIBRAD_OK;
}

const double *fibrad_heat_gathered(fibrad_heat *heat) {
    const uint32_t others = fibrad_heat_others(heat), of_walls = heat->patches - others;
    double *sum = heat->solution.gathered + others;
    fibrad_zero(sum, of_walls * sizeof *sum);
    for (uint32_t part = 0; part < heat->config.parts; part++) {
        const double *from = heat->solution.brought + (size_t)part * of_walls;
        for (uint32_t a = 0; a < of_walls; a++) sum[a] += from[a];
    }
    return heat->solution.gathered;
}

/* The bed is divided into parts by halving it across its longest extent again and again. So few beams go from part to
 * part, and spheres that follow each other in the sequence are near each other. */
#define FEW_SPHERES 32u /* a range with fewer spheres is not halved further */
#define HALVES_MAX  64  /* largest number of ranges that wait to be halved */

/* A range of spheres in the sequence, and the range of parts to which they belong. */
struct bed_range {
    uint32_t begin, end, first, last;
};

static bool sphere_before(const double *x, uint32_t a, uint32_t b) { return x[a] != x[b] ? x[a] < x[b] : a < b; }

/* Reorders a range so that the spheres before position `cut` have smaller x than those after it. */
static void split_range(uint32_t *sphere, struct bed_range range, uint32_t cut, const double *x) {
    uint32_t begin = range.begin, end = range.end;
    while (end - begin > 1) {
        const uint32_t middle = sphere[begin + (end - begin) / 2];
        uint32_t low = begin, high = end;
        for (;;) {
            while (sphere_before(x, sphere[low], middle)) low++;
            while (sphere_before(x, middle, sphere[high - 1])) high--;
            if (low + 1 >= high) break;
            const uint32_t other = sphere[low];
            sphere[low++] = sphere[--high], sphere[high] = other;
        }
        /* between high and low there is at most the middle sphere */
        if (cut >= low && cut <= high) return;
        if (cut < low)
            end = low;
        else
            begin = high;
    }
}

/* The coordinates, x, y or z, along which a range is longest. */
static const double *longest_extent(const fibrad_heat *heat, struct bed_range range) {
    const double *const of[3] = {heat->scene->x, heat->scene->y, heat->scene->z};
    double longest = -1;
    const double *along = of[0];
    for (int axis = 0; axis < 3; axis++) {
        double low = __builtin_inf(), high = -__builtin_inf();
        for (uint32_t k = range.begin; k < range.end; k++) {
            const double x = of[axis][heat->sequence[k]];
            low = fibrad_min(low, x), high = fibrad_max(high, x);
        }
        if (high - low > longest) longest = high - low, along = of[axis];
    }
    return along;
}

/* Rows of fine fours belong to the part of their sphere. Those of walls belong to all parts in turn. */
static void divide_fine_rows(fibrad_heat *heat) {
    for (uint32_t row = heat->spheres; row < heat->rows; row++) {
        const uint32_t body = fibrad_heat_body_of_row(heat, row);
        heat->part[row] = body < heat->spheres ? heat->part[body] : (uint16_t)(row % heat->config.parts);
    }
}

void fibrad_heat_divide(fibrad_heat *heat) {
    const uint32_t n = heat->spheres;
    struct bed_range wait[HALVES_MAX];
    int waiting = 0;
    for (uint32_t k = 0; k < n; k++) heat->sequence[k] = k;
    wait[waiting++] = (struct bed_range){0, n, 0, heat->config.parts};
    while (waiting > 0) {
        const struct bed_range range = wait[--waiting];
        const bool one = range.last - range.first == 1;
        const uint32_t part = range.first + (range.last - range.first) / 2;
        const uint32_t cut = one ? range.begin + (range.end - range.begin) / 2 : fibrad_heat_part_begin(heat, n, part);
        if (one && range.end - range.begin <= FEW_SPHERES) {
            for (uint32_t k = range.begin; k < range.end; k++) heat->part[heat->sequence[k]] = (uint16_t)range.first;
            continue;
        }
        split_range(heat->sequence, range, cut, longest_extent(heat, range));
        wait[waiting++] = (struct bed_range){range.begin, cut, range.first, one ? range.last : part};
        wait[waiting++] = (struct bed_range){cut, range.end, one ? range.first : part, range.last};
    }
    divide_fine_rows(heat);
}
