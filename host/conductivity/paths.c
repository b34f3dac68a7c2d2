/* paths.c - effective radiative conductivity of a bed of grey spheres, by paths. SPDX-License-Identifier: MIT
 *
 * Each batch of paths has a seed of its own. The paths of one sphere in one batch are a group. The kernel estimates the
 * standard error of a group. Groups are independent, so their variances add up. */
#include "conductivity/conductivity.h"

#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "simple/team.h"
#include "text/read_number.h"

#define PI 3.14159265358979323846

/* Fewest emitters of a bed with an open axis. */
#define EMITTERS 40u

enum { EMITTERS_AT_ONCE = 16 }; /* that a thread takes */

/* Constants of a search for --error. The kernel compares the paths of a group in PARTS parts. */
#define PILOT      50000.0 /* paths of the first round, in all */
#define GROUPS     256.0   /* fewest groups of a round */
#define PARTS      16u     /* the paths of a group are a multiple */
#define GROWTH     8.0     /* largest ratio of all paths after a round to those before */
#define BATCH_MOST (FIBRAD_PATHS_MAX / PARTS * PARTS)

/* find_isothermal looks for the conductivity at which F_E is this part of F_E of spheres with one temperature. */
#define RIGHT 0.95

/* Flights whose displacements are correlated if an effective emissivity is below 0.1, and below 0.01. */
enum { FLIGHTS_SLOW = 24, FLIGHTS_SLOWEST = 48 };

/* A standard error is unreliable if the concentration is larger than this. The square root of the concentration is the
 * relative standard error of the variance. If the variances of groups have a tail of index a < 1, the concentration
 * tends to 1 - a however many groups there are: 1/4 for flights along channels, 1/2 for flights in slabs
 * (docs/methods.md section 24). Without such a tail it tends to 0. */
#define SETTLED 0.03

/* Growth of F_E over F_E from which flights count as endless, however large the standard error is. Flights of 100
 * periods are about e^10 times as long as a gap. So such a growth adds 0.003 to F_E, which is the default of --error.
 */
#define ENDLESS 0.0003

/* Largest parts that may leave the bed: of what the core emits, and of the paths of spheres that conduct. */
#define LEAVING       1e-3
#define LEAVING_WALKS 0.05

/* The core of the bed, which emits: a box, infinite along periodic axes. */
struct core {
    double low[3], high[3], volume;
};

/* Where a wall across an axis ends the bed, low or high. NaN: there is no such wall. */
static double wall_end(const struct walls *walls, int axis, bool upper) {
    for (uint32_t k = 0; walls && k < walls->count; ++k) {
        const fibrad_wall *wall = &walls->wall[k];
        if (wall->kind == FIBRAD_WALL_PLANE && wall->plane.axis == axis && wall->plane.upper == upper)
            return wall->plane.at;
    }
    return NAN;
}

double conduction_width(const struct bed *bed, const struct walls *walls, int axis) {
    if (bed->period[axis] > 0) return bed->period[axis];
    for (uint32_t k = 0; walls && k < walls->count; ++k)
        if (walls->wall[k].kind == FIBRAD_WALL_CYLINDER && wall_across(&walls->wall[k], axis))
            return sqrt(PI) * walls->wall[k].cylinder.radius;
    return wall_end(walls, axis, true) - wall_end(walls, axis, false);
}

static int find_core(const struct bed *bed, const struct walls *walls, int wanted, double margin, const char *file,
                     double diameter, struct core *core) {
    core->volume = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double width = conduction_width(bed, walls, axis), *at = bed_centres(bed, axis);
        core->low[axis] = -INFINITY;
        core->high[axis] = INFINITY;
        if (!isnan(width)) {
            core->volume *= width;
            continue;
        }
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < bed->n; ++i) low = fmin(low, at[i]), high = fmax(high, at[i]);
        const double lower = wall_end(walls, axis, false), upper = wall_end(walls, axis, true);
        core->low[axis] = isnan(lower) ? low + margin * diameter : lower;
        core->high[axis] = isnan(upper) ? high - margin * diameter : upper;
        const bool thin = !(core->high[axis] > core->low[axis]);
        if (thin && wanted >= 0 && wanted != axis)
            core->low[axis] = bed_reach(bed, axis, false), core->high[axis] = bed_reach(bed, axis, true);
        if (thin && (wanted < 0 || wanted == axis))
            return message_at(
                STATUS_INPUT, file, 0,
                "the bed is too thin along the open axis %c, where at least %g mean diameters are needed%s", 'x' + axis,
                2 * margin, wanted < 0 ? "; --axis computes F_E along another axis" : "");
        core->volume *= core->high[axis] - core->low[axis];
    }
    return STATUS_OK;
}

static bool is_inside(const struct core *core, const double at[3]) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(at[axis] >= core->low[axis] && at[axis] < core->high[axis])) return false;
    return true;
}

/* The fraction of a sphere that lies in the core, by points. Counting centres would be rough if the core is small. */
static double fraction_inside(const struct bed *bed, uint32_t i, const struct core *core) {
    enum { POINTS = 256 };
    uint32_t count = 0;
    for (uint32_t k = 0; k < POINTS; ++k) {
        double w[3];
        fibrad_direction(k, POINTS, w);
        const double depth = bed->r[i] * cbrt(fmod((k + .5) * .7548776662466927, 1)); /* uniform in volume */
        const double at[3] = {bed->x[i] + depth * w[0], bed->y[i] + depth * w[1], bed->z[i] + depth * w[2]};
        count += is_inside(core, at);
    }
    return count / (double)POINTS;
}

struct extent {
    double low, high;
};

/* Sum of squared widths of all gaps across a periodic axis. A gap is a slab without spheres. */
static double square_gaps(const struct bed *bed, int axis, struct extent *extents) {
    const double *at = bed_centres(bed, axis), period = bed->period[axis];
    double reach = -INFINITY, sum = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double low = at[i] - bed->r[i], inside = low - period * floor(low / period);
        extents[i] = (struct extent){inside, inside + 2 * bed->r[i]};
        reach = fmax(reach, extents[i].high - period);
    }
    qsort(extents, bed->n, sizeof *extents, number_order);
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (extents[i].low > reach) sum += pow(extents[i].low - reach, 2);
        reach = fmax(reach, extents[i].high);
    }
    return sum;
}

/* Finds the growth of F_E. A slab of width h across an axis of period P adds h^2/(P d) ln(L/h) to F_E along the other
 * two axes, with the mean diameter d and the longest flight L (docs/methods.md section 24). */
static int find_growth(const struct bed *bed, struct conduction *result) {
    if (bed->period[0] == 0 || bed->period[1] == 0 || bed->period[2] == 0) return STATUS_OK;
    struct extent *extents = malloc(bed->n * sizeof *extents);
    if (!extents) return message_memory();
    for (int across = 0; across < 3; ++across) {
        const double growth = square_gaps(bed, across, extents) / (bed->period[across] * result->diameter);
        for (int axis = 0; axis < 3; ++axis)
            if (axis != across) result->growth[axis] += growth;
    }
    free(extents);
    return STATUS_OK;
}

/* The volume of the emitters is that of their spheres over the solid fraction of the core. */
int conduction_emitters(const struct bed *bed, const struct walls *walls, int axis, double margin, const char *file,
                        unsigned char *emits, struct conduction *result) {
    struct core core;
    double solid = 0, emitting = 0;
    *result = (struct conduction){.temperature = NAN};
    result->diameter = bed_diameter(bed);
    const int status = find_core(bed, walls, axis, margin, file, result->diameter, &core);
    if (status) return status;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double volume = 4 * PI / 3 * pow(bed->r[i], 3);
        emits[i] = is_inside(&core, (const double[]){bed->x[i], bed->y[i], bed->z[i]});
        emitting += emits[i] * volume;
        solid += fraction_inside(bed, i, &core) * volume;
        result->emitters += emits[i];
    }
    result->solid_fraction = solid / core.volume;
    result->volume = emitting / result->solid_fraction;
    const bool open = bed->period[0] == 0 || bed->period[1] == 0 || bed->period[2] == 0;
    if (open && result->emitters < EMITTERS)
        return message_at(STATUS_INPUT, file, 0, "only %u spheres are %g mean diameters inside the bed, %u are needed",
                          result->emitters, margin, EMITTERS);
    return find_growth(bed, result);
}

/* Sums over all groups of all batches so far. Each group is weighted by its number of paths. */
struct tally {
    uint64_t batches;
    uint64_t paths;                           /* from each emitter */
    double factor[3], variance[3], fourth[3]; /* F_E, its variance, and squared variances of groups */
    double lost, all;                         /* emission that no sphere absorbs, and all emission */
    double expected, expected_fourth;         /* variance and squares if flights were as long as the sphere */
    fibrad_displacement *moved;               /* [n] of the last batch */
};

/* Adds a batch of `paths` paths from each emitter, in the order of spheres, so that threads change no bit. */
static void add_batch(struct tally *tally, const struct bed *bed, const unsigned char *emits,
                      const struct conduction_rule *rule, uint32_t paths, struct conduction *result) {
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (!emits[i]) continue;
        const fibrad_displacement *moved = &tally->moved[i];
        const double emissivity =
            rule->conductivity ? 1 : rule->emissivity[i]; /* a walk loses nothing where it arrives */
        const double emission = 4 * PI * bed->r[i] * bed->r[i] * emissivity * paths;
        const double weight = emission / (2 * result->volume * result->diameter);
        for (int axis = 0; axis < 3; ++axis) {
            const double variance = pow(weight * moved->error[axis], 2);
            tally->factor[axis] += weight * moved->square[axis];
            tally->variance[axis] += variance;
            tally->fourth[axis] += variance * variance;
        }
        const double expected = paths * pow(emissivity * pow(bed->r[i], 4), 2);
        tally->expected += expected;
        tally->expected_fourth += expected * expected;
        tally->lost += emission * (1 - moved->absorbed);
        tally->all += emission;
        result->rays += moved->rays;
    }
    tally->batches++;
    tally->paths += paths;
}

static void read_tally(const struct tally *tally, struct conduction *result) {
    /* A few large spheres among small ones concentrate the variance, too. This is a rough estimate, hence the 2. */
    const double sizes = 2 * tally->expected_fourth / (tally->expected * tally->expected);
    result->paths = tally->paths;
    for (int axis = 0; axis < 3; ++axis) {
        const double variance = tally->variance[axis];
        result->factor[axis] = tally->factor[axis] / (double)tally->paths;
        result->error[axis] = sqrt(variance) / (double)tally->paths;
        result->concentration[axis] = variance > 0 ? tally->fourth[axis] / (variance * variance) - sizes : 0;
    }
    result->escaped = fmax(0, tally->lost / tally->all);
}

/* What follows paths: a scene, its threads, and the emitters in the order of the cells. */
struct follower {
    const struct bed *bed;
    const unsigned char *emits;
    const struct conduction_rule *rule;
    fibrad_run *run;
    fibrad_scene *scene;
    void *block;
    fibrad_team team;
    uint32_t *order; /* [emitters] */
    fibrad_displacement_rule how;
    struct tally tally;
};

static void follower_close(struct follower *f) {
    fibrad_team_close(&f->team);
    free(f->block);
    free(f->order);
    free(f->tally.moved);
}

static int follower_open(struct follower *f, const struct bed *bed, const unsigned char *emits,
                         const struct conduction_rule *rule, fibrad_run *run) {
    static const double mirrors[WALLS_MAX] = {0};
    const fibrad_scene_config scene = bed_scene(bed, rule->walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    *f = (struct follower){.bed = bed, .emits = emits, .rule = rule, .run = run};
    f->how = (fibrad_displacement_rule){
        .emissivity = rule->emissivity, .wall_emissivity = mirrors, .conductivity = rule->conductivity};
    f->order = calloc((size_t)bed->n + 1, sizeof *f->order);
    f->tally.moved = calloc((size_t)bed->n + 1, sizeof *f->tally.moved);
    int status = f->order && f->tally.moved ? fibrad_heap_scene(&f->scene, &f->block, &scene, &spheres, &run->fault)
                                            : FIBRAD_E_MEMORY;
    uint32_t count = 0;
    for (uint32_t k = 0; k < bed->n && !status; ++k) {
        const uint32_t i = fibrad_scene_sphere(f->scene, k);
        if (emits[i]) f->order[count++] = i;
    }
    const fibrad_run own = {.threads = count == 1 ? 1 : run->threads, run->progress, run->context, run->fault};
    return status ? status : fibrad_team_open(&f->team, &own); /* batches of one sphere are too short for threads */
}

static int follow_sphere(void *follower, int thread, uint32_t task) {
    struct follower *f = follower;
    const uint32_t i = f->order[task];
    return fibrad_exchange_displacement(f->scene, &f->team.work[thread], i, &f->how, &f->tally.moved[i]);
}

/* Follows `paths` more paths from each emitter, divided among batches. */
static int follow_round(struct follower *f, uint32_t batches, uint64_t paths, struct conduction *result) {
    f->how.flights = result->flights;
    for (uint32_t batch = 0; batch < batches; ++batch) {
        const uint32_t share = (uint32_t)(paths / batches + (batch < paths % batches));
        uint32_t failed;
        f->how.paths = share, f->how.seed = f->rule->seed + f->tally.batches * 0x9e3779b97f4a7c15u;
        int status = batches > 1 ? fibrad_team_report(&f->team, "rows", batch, batches) : FIBRAD_OK;
        if (status) return status;
        status = fibrad_team_run(&f->team, batches > 1 ? NULL : "rows", result->emitters, EMITTERS_AT_ONCE,
                                 follow_sphere, f, &failed);
        if (status && failed < result->emitters)
            f->run->fault = (fibrad_fault){f->order[failed], f->order[failed], f->team.triangle, 0, 0};
        if (status) return status;
        add_batch(&f->tally, f->bed, f->emits, f->rule, share, result);
    }
    read_tally(&f->tally, result);
    return FIBRAD_OK;
}

double conduction_worst(const struct conduction_rule *rule, const struct conduction *result) {
    double worst = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (result->factor[axis] > 0 && (rule->axis < 0 || rule->axis == axis) &&
            conduction_flights(result, axis) != FLIGHTS_ENDLESS)
            worst = fmax(worst, result->error[axis] / result->factor[axis]);
    return worst;
}

/* Follows rounds of more and more paths until the error is reached, with a tenth to spare, or the rays are used up. */
static int search(struct follower *f, uint32_t batches, struct conduction *result) {
    const struct conduction_rule *rule = f->rule;
    const uint32_t step = PARTS * batches;
    double more = PILOT / result->emitters;
    while (!result->stopped && more > 0) {
        const uint64_t steps = (uint64_t)fmin(BATCH_MOST / PARTS, ceil(more / step));
        const int status = follow_round(f, batches, steps * step, result);
        if (status) return status;
        const double paths = (double)result->paths, left = (double)rule->max_rays - (double)result->rays;
        const double affordable = floor(paths * left / (double)result->rays / step) * step;
        const double over = conduction_worst(rule, result) / rule->error;
        more = fmin(over > 1 ? 1.1 * over * over * paths : 0, GROWTH * paths) - paths;
        if (more > affordable) result->stopped = affordable < step, more = affordable;
    }
    return FIBRAD_OK;
}

/* Describes k* of the spheres, and chooses the flights whose displacements are correlated. Reflection keeps
 * displacements correlated. Patterns of degree 1 are reflected, too: their emissivity is 1/(1/e + 1/(2 k*)). */
static void describe_conducting(const struct bed *bed, const struct conduction_rule *rule, struct conduction *result) {
    double least = 1;
    if (!rule->conductivity) return;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double k = rule->conductivity[i];
        k_star_add(&result->k_star, k);
        least = fmin(least, conduction_effective(rule->emissivity[i], k));
    }
    result->flights = least >= .1 ? FIBRAD_FLIGHTS_DEFAULT : least >= .01 ? FLIGHTS_SLOW : FLIGHTS_SLOWEST;
}

/* The sum of F_E over the wanted axes, from PILOT paths, with all emissivities times `scale`. */
static int follow_pilot(struct follower *f, double scale, const struct conduction *of, double *sum) {
    const struct conduction_rule *rule = f->rule;
    struct conduction result = *of;
    struct conduction_rule scaled = *rule;
    double *emissivity = malloc(f->bed->n * sizeof *emissivity);
    if (!emissivity) return FIBRAD_E_MEMORY;
    for (uint32_t i = 0; i < f->bed->n; ++i) emissivity[i] = scale * rule->emissivity[i];
    scaled.emissivity = f->how.emissivity = emissivity, f->rule = &scaled;
    f->tally = (struct tally){.moved = f->tally.moved};
    const int status = follow_round(f, 1, (uint64_t)ceil(PILOT / PARTS / of->emitters) * PARTS, &result);
    *sum = 0;
    for (int axis = 0; axis < 3; ++axis) *sum += conduction_wants(of, axis) ? result.factor[axis] : 0;
    f->how.emissivity = rule->emissivity, f->rule = rule;
    free(emissivity);
    return status;
}

/* F_E of spheres that conduct is about that of spheres with one temperature and the emissivity 1/(1/e + 1/(2 k*)). The
 * paths of both emissivities are the same, so that their noise hardly counts. Between them F_E is a power of e. */
static int find_isothermal(struct follower *f, struct conduction *result) {
    const struct bed *bed = f->bed;
    double grey, less, area = 0, weighted = 0;
    int status = follow_pilot(f, 1, result, &grey);
    if (!status) status = follow_pilot(f, RIGHT, result, &less);
    if (status) return status;
    const double power = log(less / grey) / log(RIGHT), over = pow(RIGHT, -1 / power) - 1; /* e/(2 k*) */
    for (uint32_t i = 0; i < bed->n; ++i) {
        area += pow(bed->r[i], 2);
        weighted += pow(bed->r[i], 2) * f->rule->emissivity[i] * 2 * bed->r[i] * bed->metres;
    }
    result->isothermal = weighted / area / (2 * over) * 4 * FIBRAD_STEFAN_BOLTZMANN;
    return FIBRAD_OK;
}

int conduction_follow(const struct bed *bed, const unsigned char *emits, const struct conduction_rule *rule,
                      fibrad_run *run, struct conduction *result) {
    struct follower f;
    const uint32_t batches = (uint32_t)ceil(GROUPS / result->emitters);
    const double begun = progress_clock();
    int status = follower_open(&f, bed, emits, rule, run);
    describe_conducting(bed, rule, result);
    result->axis = rule->axis;
    if (!status && rule->paths > 0)
        status = follow_round(&f, (uint32_t)fmax(1, fmin(batches, (double)rule->paths / PARTS)), rule->paths, result);
    else if (!status)
        status = search(&f, batches, result);
    result->seconds = progress_clock() - begun;
    result->isothermal = NAN;
    if (!status && rule->isothermal) status = find_isothermal(&f, result);
    follower_close(&f);
    return status;
}

void k_star_add(struct k_star *all, double relative) {
    if (isnan(relative)) return;
    if (all->spheres++ == 0) all->least = INFINITY;
    all->least = fmin(all->least, relative), all->largest = fmax(all->largest, relative);
    all->sum += relative;
}

double k_star_mean(const struct k_star *all) { return all->sum / all->spheres; }

double conduction_effective(double emissivity, double relative) {
    return emissivity > 0 ? 1 / (1 / emissivity + 1 / (2 * relative)) : 0;
}

bool conduction_wants(const struct conduction *result, int axis) { return result->axis < 0 || result->axis == axis; }

enum conduction_flights conduction_flights(const struct conduction *result, int axis) {
    if (result->growth[axis] > fmin(result->error[axis], ENDLESS * result->factor[axis])) return FLIGHTS_ENDLESS;
    if (result->escaped > (result->flights > 0 ? LEAVING_WALKS : LEAVING)) return FLIGHTS_LEAVING;
    return result->concentration[axis] > SETTLED ? FLIGHTS_RARE : FLIGHTS_SETTLED;
}

const char *conduction_doubt(const struct conduction *result, int axis) {
    switch (conduction_flights(result, axis)) {
    case FLIGHTS_ENDLESS:
        return "F_E does not exist: endless flights";
    case FLIGHTS_RARE:
        return "error unreliable: few long flights";
    case FLIGHTS_LEAVING:
        return "F_E too low: radiation leaves the bed";
    default:
        return NULL;
    }
}

void conduction_at(struct conduction *result, const struct bed *bed, double temperature) {
    result->temperature = temperature;
    const double scale = 4 * FIBRAD_STEFAN_BOLTZMANN * pow(temperature, 3) * result->diameter * bed->metres;
    for (int axis = 0; axis < 3; ++axis) {
        result->k[axis] = result->factor[axis] * scale;
        result->k_error[axis] = result->error[axis] * scale;
    }
}
