/* errors.c - estimated errors of powers and temperatures. SPDX-License-Identifier: MIT
 *
 * The model. Each number here is the square of an error. "Surface" stands for a sphere or a wall, which the code calls
 * a body.
 *
 *   1. Beams and rays are samples of all directions. Even ones and odd ones are two samples. The power by the even ones
 *      minus the power by the odd ones tells how large the error is.
 *   2. Patches have a size. The difference between the two levels of patches tells what the size still changes.
 *   3. If few beams end on a patch, too much light goes back to where it came from. The number of beams tells how much.
 *   4. The solution stops before its end. solve.c finds what the steps to come would change.
 *   5. Walls that send out too much or too little make all surfaces err that see them.
 *
 * The sum of these five is the *own sample* of a surface. It may be small by chance. Errors of surfaces of one kind are
 * what each surface exchanges times a random number that is nearly normally distributed. So all samples of one kind,
 * over all that this kind exchanges, tell the error of each. The estimate is the mean of both: of the own sample, and
 * of what all samples tell. What is smooth from wall to wall or from sphere to sphere has no part in this mean: the
 * size of the patches of walls, and of meshes beside spheres.
 *
 * A temperature that is found errs by the error of its emission, over the slope of sigma T^4. The samples are the same,
 * per area. All temperatures that are found have an error in common besides: if the powers of surfaces of given
 * temperature are wrong, all differences between found and given emissions are wrong by the same factor. Contacts pass
 * on errors of temperatures. What they pass on is the mean over solutions with random signs of all errors.
 *
 * docs/methods.md section 21 has the terms in a table. */
#include "heat/errors.h"
#include "base/vector.h"
#include "patches/subdivision.h"
#include "scene/walls.h"

/* ---- constants --------------------------------------------------------------------------------------------------
 * Each is an error over the quantity behind it. Letters say where it was measured:
 *   B  settled beds, bench_heat                       S  500 equal spheres, bench_heat, docs/heat.md "Settings"
 *   W  16 scenes between walls, bench_walls           T  14 scenes between walls, bench_tolerance
 *   D  seven dilute beds                              F  cups and boxes against closed forms
 *   P  pairs of spheres of k* .01 to 1 against rings, docs/accuracy.md "Powers of grey spheres"
 *   R  cubes, cups and mono2000 with insulated walls, docs/accuracy.md
 *   M  small spheres beside triangles against the same beside planes, which are divided
 *   L  dim walls beside few spheres, tests/test_heat_walls.c residuals_are_estimated
 *   G  150 small plates before a sphere, tests/test_heat_mesh.c
 *   E  198 pairs 10 to 1,000 radii apart, tests/test_few.c; 50 scenes of 2 to 6 spheres
 *   H  240 pairs of spheres and 400 spheres of poly2000, docs/accuracy.md
 *   K  twelve spheres in a box with 52 contacts, against 384 patches and 2000 directions */

/* 1. beams and rays */
#define BEAM_ERROR          FIBRAD_HEAT_BEAM_ERROR /* B W: even minus odd beams */
#define ONE_PARITY_ERROR    1.2                    /* D: the same times the share of spheres that one of both meets */
#define BETWEEN_BEAMS_ERROR .25                    /* D: what one direction brings, in the share of open beams */
#define FLOAT_ERROR         0x1p-25                /* what a surface exchanges: factors of pencils are floats */
#define RAY_ERROR           FIBRAD_HEAT_RAY_ERROR  /* F: even minus odd rays of a wall, two independent sequences */
#define CHANCE_ERROR        .4  /* G: of a mesh that meets spheres: the error of its rays if chance sends them */
#define BUNDLE_ERROR        2.0 /* G: the same of beams that meet it, which come in bundles */
#define RAY_SAMPLES         16  /* F: most samples of a mesh, whose rays are in so many ranges */

/* 2. patches */
#define EXTRAPOLATION_ERROR .2   /* S: change by extrapolation, with PATCHES; as the root of the edge of a patch */
#define PATCHES             96.0 /* of a sphere */
#define UNEVEN_HALF_MORE    50   /* P: 1/(2 k*) of a sphere for which this error is half as large again */
#define WALL_EXTRAPOLATION  .5   /* W: factor of this error for walls */
#define MESH_SPOT_ERROR     .7   /* M: what goes back and forth between a sphere and patches of a mesh */

/* 3. few beams on a patch: patches over beams, times the power */
#define FEW_ON_SPHERES    .25 /* B, at emissivity .3: patches of spheres */
#define FEW_ON_WALLS_SEEN 1.3 /* T: patches of walls that a sphere sees, whose beams are less even */
#define FEW_ON_WALLS      .65 /* T: for walls themselves */
#define LEVELS_ERROR      1.8 /* E: in exact rows, the change of a power from level to level */
#define SCATTERED_ERROR   1.5 /* E: the same, what comes by reflection from others */
#define FEW_AT_REFLECTORS .2  /* R: part of it that fibrad_heat_enlarged leaves at walls that send back all */

/* 4. the steps of the solution to come */
#define RESIDUAL_ERROR 2 /* L: what they would change */

/* hottest and coldest places, over their difference from the mean of the surface */
#define FACING_ERROR    .015 /* H: that face a neighbour */
#define NEIGHBOUR_ERROR .014 /* H: for each further neighbour, times the root of their number, with PATCHES */
#define OPEN_ERROR      .07  /* H: that face none, with PATCHES */
#define NEAR_WALL_ERROR .08  /* H: that face none and may have a wall near */
#define PLACE_ERROR     .05  /* H: such a place minus the hottest or coldest patch */

/* what temperatures do to flows through contacts */
#define FLOW_AT_WALL 2 /* K: at walls, where those of neighbours err together */

/* numbers of samples */
#define SAMPLES_ENOUGH 3  /* P: kinds with fewer take samples of the other kind besides */
#define SIGNS          8u /* solutions with random signs; the standard error of their mean is a third */

static double squared(double x) { return x * x; }

/* ---- what a surface exchanges ----------------------------------------------------------------------------------- */

static fibrad_heat_spread spread_over(const fibrad_heat *heat, uint32_t begin, uint32_t end) {
    fibrad_heat_spread s = {0, 0, 0};
    for (uint32_t a = begin; a < end; a++)
        s.area += heat->solution.area[a], s.mean += heat->solution.area[a] * heat->solution.radiosity[a];
    if (!(s.area > 0)) return s;
    s.mean /= s.area;
    for (uint32_t a = begin; a < end; a++)
        s.variance += heat->solution.area[a] / s.area * squared(heat->solution.radiosity[a] - s.mean);
    return s;
}

static fibrad_heat_spread spread_of(const fibrad_heat *heat, uint32_t b) {
    return spread_over(heat, heat->first[b], heat->first[b + 1]);
}

/* The mean square difference of all radiosities from that of a surface. */
static double distance_of(const fibrad_heat_errors *errors, const fibrad_heat_spread *own) {
    return errors->all.variance + squared(own->mean - errors->all.mean);
}

/* What a surface exchanges: emissivity times area times the root of distance_of. */
static double exchange_of(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const fibrad_heat_spread own = spread_of(heat, b);
    return heat->sources.emissivity[b] * own.area * fibrad_sqrt(distance_of(errors, &own));
}

/* ---- 1. beams and rays ------------------------------------------------------------------------------------------ */

/* The number of the body of a patch, counted from the first body that is not a sphere. The search begins at body
 * `guess`, since rays are in the order of the bodies. */
static uint32_t other_of_patch(const fibrad_heat *heat, uint32_t patch, uint32_t guess) {
    const uint32_t *first = heat->first + heat->spheres, bodies = heat->bodies - heat->spheres;
    while (patch < first[guess] || patch >= first[guess + 1]) guess = guess + 1 < bodies ? guess + 1 : 0;
    return guess;
}

/* Adds the difference between the even and the odd rays of a range to the samples. */
static void sample_rays(const fibrad_heat *heat, uint32_t begin, uint32_t end, fibrad_heat_errors *errors) {
    const uint32_t bodies = heat->bodies - heat->spheres;
    double half[FIBRAD_HEAT_OTHERS] = {0}, share[FIBRAD_HEAT_OTHERS] = {0}, outside = 0;
    uint32_t from = 0, to = 0;
    for (uint32_t b = 0; b < bodies; b++) share[b] = fibrad_heat_outside(heat, heat->spheres + b);
    for (uint32_t k = begin; k < end; k++) {
        const fibrad_heat_ray *ray = &heat->ray[k];
        if (ray->area == 0) continue;
        const double flow = ray->area * (heat->solution.source[ray->to] - heat->solution.source[ray->from]);
        from = other_of_patch(heat, ray->from, from);
        half[from] += k % 2 ? -flow : flow;
        if (ray->to < fibrad_heat_others(heat)) continue; /* sweep.c has the samples of spheres */
        to = other_of_patch(heat, ray->to, to);
        half[to] -= k % 2 ? -flow : flow;
        if ((share[from] > 0) != (share[to] > 0)) errors->outside_area += ray->area;
    }
    for (uint32_t b = 0; b < bodies; b++) {
        errors->rays[b] += squared(half[b]);
        outside += share[b] * half[b];
    }
    errors->outside += squared(outside);
}

/* The square of the error of what rays of a mesh and beams of spheres bring each other. So few of them hit that it is
 * chance, more or less, how many do. A ray that meets a sphere tells how many beams of the sphere should meet the mesh.
 * The mesh may also lack one ray, or have one too many. 0: no ray meets a sphere. */
static double chance_of_rays(const fibrad_heat *heat, const fibrad_heat_rays *sent) {
    double sum = 0, squares = 0, beams = 0;
    bool met = false;
    for (uint32_t k = sent->first; k < sent->first + sent->count; k++) {
        const fibrad_heat_ray *ray = &heat->ray[k];
        if (ray->area == 0) continue;
        const double flow = ray->area * (heat->solution.source[ray->to] - heat->solution.source[ray->from]);
        sum += flow, squares += squared(flow);
        if (ray->to >= fibrad_heat_others(heat)) continue;
        beams += squared(flow) * (1 / (ray->area * sent->density) - 1);
        met = true;
    }
    const double one = sum / sent->count, rays = fibrad_max(0, squares - sum * one);
    return met ? squared(CHANCE_ERROR) * rays + squared(BUNDLE_ERROR) * beams + squared(one) : 0;
}

/* Samples the rays of all walls. Those of a mesh are divided into ranges, which have sequences of their own. Returns
 * the number of samples minus the number of walls. */
static double sample_all_rays(const fibrad_heat *heat, fibrad_heat_errors *errors) {
    double more = 0;
    for (uint32_t slot = 0; slot < FIBRAD_MESHES + heat->meshes; slot++) {
        const fibrad_heat_rays *sent = &heat->sent[slot];
        const uint32_t *first = heat->scene->mesh.first, mesh = slot - FIBRAD_MESHES;
        const bool many = slot >= FIBRAD_MESHES && first[mesh + 1] - first[mesh] >= RAY_SAMPLES;
        const uint32_t ranges = many ? RAY_SAMPLES : 1;
        const double chance = slot >= FIBRAD_MESHES ? chance_of_rays(heat, sent) : 0;
        const double before = chance > 0 ? errors->rays[FIBRAD_WALLS + mesh] : 0;
        for (uint32_t k = 0; k < ranges; k++)
            sample_rays(heat, sent->first + (uint32_t)((uint64_t)sent->count * k / ranges),
                        sent->first + (uint32_t)((uint64_t)sent->count * (k + 1) / ranges), errors);
        more += chance > 0 ? RAY_SAMPLES - 1 : ranges - 1;
        if (!(chance > 0)) continue;
        errors->rays[FIBRAD_WALLS + mesh] = before + chance / squared(RAY_ERROR);
        errors->meets[FIBRAD_WALLS + mesh] = true;
    }
    return more;
}

static double ray_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    return b >= heat->spheres ? squared(RAY_ERROR) * errors->rays[b - heat->spheres] : 0;
}

/* Over the squared difference between even and odd beams. */
static double beam_error(const fibrad_heat *heat, uint32_t b) {
    const fibrad_heat_seen *seen = &heat->samples.seen[b];
    const double lone = b < heat->spheres && seen->squares > 0 ? seen->one_parity / seen->squares : 0;
    return squared(BEAM_ERROR) + squared(ONE_PARITY_ERROR * lone);
}

/* Of what beams and rays bring a surface. */
static double sampled_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const double met = b < heat->spheres ? squared(CHANCE_ERROR) * heat->samples.seen[b].rays : 0;
    return beam_error(heat, b) * squared(heat->samples.halves[b]) + ray_error(heat, errors, b) + met;
}

/* Of what no beam tells: between the directions that meet no sphere there may be spheres. If all spheres were asked
 * for, only rounding is left. */
static double unseen_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const double open = fibrad_max(0, 1 - heat->samples.seen[b].met / heat->beams);
    const double unseen =
        heat->pencils.row[b].complete ? 0 : open * squared(BETWEEN_BEAMS_ERROR / heat->config.directions);
    return (unseen + squared(FLOAT_ERROR)) * squared(exchange_of(heat, errors, b));
}

/* ---- 2. patches ------------------------------------------------------------------------------------------------- */

/* What remains, not squared, after extrapolation has changed a value by `change`. */
static double extrapolation_error(const fibrad_heat *heat, double change) {
    return EXTRAPOLATION_ERROR * fibrad_sqrt(fibrad_sqrt(PATCHES / heat->config.patches)) * change;
}

/* The same of a power. */
static double patch_error(const fibrad_heat *heat, uint32_t b) {
    const double change = extrapolation_error(heat, heat->solution.power[b] - heat->solution.coarse[b]);
    if (b >= heat->spheres) return WALL_EXTRAPOLATION * change;
    const double uneven = heat->sources.unevenness[b];
    return (1 + uneven / (uneven + UNEVEN_HALF_MORE)) * change;
}

/* Not squared: what goes back and forth between a sphere and a mesh whose patches are too large. */
static double spot_error(const fibrad_heat *heat, uint32_t b) {
    const uint32_t mesh = fibrad_heat_body(heat, FIBRAD_MESHES);
    double back = 0;
    if (b >= heat->spheres) return 0;
    for (uint32_t m = 0; m < heat->meshes; m++) back = fibrad_max(back, 1 - heat->sources.emissivity[mesh + m]);
    return MESH_SPOT_ERROR * back * fibrad_heat_comes_back(heat, b) * heat->solution.power[b];
}

/* ---- 3. few beams on a patch, over the power -------------------------------------------------------------------- */

static double few_of_sphere(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const double *reflected = heat->samples.seen[b].reflected;
    const double walls =
        reflected[1] > 0 ? FEW_ON_WALLS_SEEN * reflected[1] / heat->beams / (heat->density[b] * heat->patch_area) : 0;
    return reflected[0] / heat->beams * squared(errors->few) + squared(walls);
}

/* Of a wall, which beams of spheres and rays meet; not squared. Half of the rays are its own. */
typedef struct few_links {
    double rays, beams;
} few_links;

static few_links few_of_wall(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const uint32_t k = b - heat->spheres, slot = k < FIBRAD_WALLS ? k : FIBRAD_MESHES + (k - FIBRAD_WALLS);
    const fibrad_heat_rays *sent = &heat->sent[slot];
    const double area = spread_of(heat, b).area;
    double rays = 0;
    for (uint32_t r = sent->first; r < sent->first + sent->count; r++)
        rays += (heat->ray[r].to < fibrad_heat_others(heat) ? 1 : 2) * heat->ray[r].area;
    const double share = area > 0 ? fibrad_min(1, rays / area) : 0, patch = fibrad_min(heat->patch_area, area);
    return (few_links){share > 0 ? FEW_ON_WALLS * share * errors->dim[1] / (2 * sent->density * patch) : 0,
                       FEW_ON_WALLS * (1 - share) * errors->dim[0] * heat->config.patches / heat->beams};
}

static double few_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    if (b < heat->spheres) return few_of_sphere(heat, errors, b);
    const few_links few = few_of_wall(heat, errors, b);
    return squared(few.rays + few.beams);
}

/* ---- exact rows ------------------------------------------------------------------------------------------------- */

/* Whether a sphere exchanges all it does with surroundings and with spheres of exact factors. */
static bool is_exact(const fibrad_heat *heat, uint32_t b) {
    return b < heat->spheres && heat->scene->facts.walls == 0 && heat->pencils.row[b].complete &&
           heat->samples.seen[b].squares == 0;
}

/* What a sphere gets of light that others reflect, the surroundings' aside, about. Few beams may miss it. */
static double scattered(const fibrad_heat *heat, uint32_t b, double outside) {
    const fibrad_scene *scene = heat->scene;
    const double *x = scene->x, *y = scene->y, *z = scene->z;
    double sum = 0;
    for (uint32_t j = 0; j < heat->spheres; j++) {
        const double c[3] = {x[j] - x[b], y[j] - y[b], z[j] - z[b]}, eps = heat->sources.emissivity[j];
        const double reflected = spread_of(heat, j).mean - eps * heat->sources.emission[j] - (1 - eps) * outside;
        if (j != b) sum += scene->r[j] * scene->r[j] / (4 * fibrad_dot(c, c)) * fibrad_abs(reflected);
    }
    return heat->sources.emissivity[b] * spread_of(heat, b).area * sum;
}

/* The square of the error of its power. Patches, and few beams on them, show in the difference between the levels. */
static double exact_error(const fibrad_heat *heat, uint32_t b) {
    const fibrad_heat_spread own = spread_of(heat, b), outside = spread_of(heat, heat->bodies - 1);
    const double power = heat->solution.power[b], changed = power - heat->solution.coarse[b];
    const double lost = heat->sources.emissivity[b] * own.area * (own.mean - outside.mean);
    return squared(LEVELS_ERROR * changed) + squared(RESIDUAL_ERROR * heat->solution.unsettled[b]) +
           squared(SCATTERED_ERROR * scattered(heat, b, outside.mean)) +
           squared(2 * FLOAT_ERROR) * (squared(power) + squared(lost));
}

/* ---- powers ----------------------------------------------------------------------------------------------------- */

static double own_sample(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const double eps = heat->sources.emissivity[b], few = few_error(heat, errors, b);
    const double seen = errors->all.area > 0 ? eps * spread_of(heat, b).area / errors->all.area : 0;
    const double sphere = b < heat->spheres ? squared(patch_error(heat, b)) + unseen_error(heat, errors, b) : 0;
    return squared(eps) * sampled_error(heat, errors, b) + sphere + few * squared(heat->solution.power[b]) +
           squared(seen * errors->walls) + squared(RESIDUAL_ERROR * heat->solution.unsettled[b]);
}

/* Finds how dim spheres and walls are on the mean. */
static void find_dim(const fibrad_heat *heat, fibrad_heat_errors *errors) {
    double areas[2] = {0, 0};
    for (uint32_t b = 0; b < fibrad_heat_beyond(heat, 0); b++) {
        const int kind = b >= heat->spheres;
        const double area = spread_of(heat, b).area;
        areas[kind] += area;
        errors->dim[kind] +=
            area * (fibrad_heat_reflects(heat, b) ? FEW_AT_REFLECTORS : fibrad_heat_sent_back(heat, b));
    }
    for (int kind = 0; kind < 2; kind++)
        if (areas[kind] > 0) errors->dim[kind] /= areas[kind];
}

/* Finds the error of what all walls send out. */
static void find_sent(const fibrad_heat *heat, fibrad_heat_errors *errors) {
    for (uint32_t b = heat->spheres; b < fibrad_heat_beyond(heat, 0); b++)
        errors->walls += squared(fibrad_heat_is_free(heat, b) ? 1 : 1 - heat->sources.emissivity[b]) *
                         sampled_error(heat, errors, b);
    errors->walls = fibrad_sqrt(errors->walls + squared(RESIDUAL_ERROR * heat->solution.sent_unsettled));
}

/* Adds up the own samples of spheres, and of walls. */
static void find_pools(const fibrad_heat *heat, fibrad_heat_errors *errors) {
    for (uint32_t b = 0; b < fibrad_heat_beyond(heat, 0); b++) {
        fibrad_heat_pool *pool = &errors->pool[b >= heat->spheres];
        const double exchange = exchange_of(heat, errors, b);
        if (!(exchange > 0) || fibrad_heat_is_free(heat, b)) continue;
        pool->samples++, pool->errors += own_sample(heat, errors, b), pool->exchanges += squared(exchange);
    }
}

/* Of the power of a body, whether it is given or not. */
static double estimated_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const double exchange = exchange_of(heat, errors, b);
    const int own = b >= heat->spheres;
    double sum = 0, samples = 0;
    for (int kind = 0; kind < 2; kind++) {
        const fibrad_heat_pool *pool = &errors->pool[kind];
        if (!(pool->exchanges > 0)) continue;
        const double weight = kind == own ? pool->samples : fibrad_max(0, SAMPLES_ENOUGH - errors->pool[own].samples);
        sum += weight * pool->errors / pool->exchanges, samples += weight;
    }
    const double sample = exchange > 0 ? own_sample(heat, errors, b) : 0;
    const double alone = b < heat->spheres ? sample : 0; /* the powers of all others are given */
    const double pooled = samples > 0 ? sum / samples * squared(exchange) : alone;
    const double smooth = b < heat->spheres ? spot_error(heat, b) : patch_error(heat, b);
    const double all = exchange > 0 ? squared(smooth) + (sample + pooled) / 2 : 0;
    return is_exact(heat, b) ? fibrad_min(all, exact_error(heat, b)) : all;
}

/* How much the emission of a mesh whose sides have films or powers follows what it receives; 0 of other bodies. */
static double answer_of(const fibrad_heat *heat, uint32_t b) {
    return fibrad_heat_finds_sides(heat, b)
               ? fibrad_heat_mean(heat, b, heat->sources.answer - fibrad_heat_first_meshed(heat))
               : 0;
}

double fibrad_heat_radiated_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    return fibrad_heat_is_free(heat, b) ? 0 : squared(1 - answer_of(heat, b)) * estimated_error(heat, errors, b);
}

double fibrad_heat_power_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b) {
    const double square = fibrad_heat_radiated_error(heat, errors, b);
    if (fibrad_heat_is_free(heat, b) && fibrad_heat_is_member(heat, b)) /* that of the whole clump is given */
        return fibrad_sqrt(estimated_error(heat, errors, b) + heat->contacts.supply[b] +
                           squared(heat->film[b] * heat->contacts.error[b]));
    if (!heat->contacts.joins || fibrad_heat_is_free(heat, b)) return fibrad_sqrt(square);
    return fibrad_sqrt(square + heat->contacts.supply[b]);
}

void fibrad_heat_mean_errors(const fibrad_heat *heat, const fibrad_heat_errors *errors, double *of_patches,
                             double *of_beams) {
    const double spheres = fibrad_max(1, heat->spheres);
    double patches = 0, all = 0;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const double square = fibrad_heat_radiated_error(heat, errors, b);
        if (square > 0) patches += squared(patch_error(heat, b)) + squared(spot_error(heat, b));
        all += square;
    }
    patches = fibrad_min(patches, all);
    *of_patches = fibrad_sqrt(patches / spheres), *of_beams = fibrad_sqrt((all - patches) / spheres);
}

/* Of the power that spheres give to the surroundings. Each sphere is a sample. If too few spheres see the surroundings,
 * the errors of their own powers are taken as well. */
static double outside_by_spheres(const fibrad_heat *heat, const fibrad_heat_errors *errors) {
    double square = 0, spheres = 0, all = 0;
    for (uint32_t b = 0; b < heat->spheres; b++)
        square += beam_error(heat, b) * squared(heat->samples.seen[b].escaping),
            spheres += heat->samples.seen[b].escaping != 0;
    if (spheres == 0 || spheres >= SAMPLES_ENOUGH) return square;
    for (uint32_t b = 0; b < heat->spheres; b++) all += fibrad_heat_radiated_error(heat, errors, b);
    return (spheres * square + (SAMPLES_ENOUGH - spheres) * all) / SAMPLES_ENOUGH;
}

/* Of the power that walls give to the surroundings. Its relative error is taken to be that of what walls exchange with
 * each other. */
static double outside_by_walls(const fibrad_heat *heat, const fibrad_heat_errors *errors) {
    double missed = 0, exchanges = 0;
    for (uint32_t b = heat->spheres; b < fibrad_heat_beyond(heat, 0); b++)
        missed += squared(heat->sources.emissivity[b]) * ray_error(heat, errors, b),
            exchanges += squared(exchange_of(heat, errors, b));
    if (!(exchanges > 0)) return 0;
    return missed / exchanges * squared(errors->outside_area) * (errors->all.variance + squared(errors->all.mean));
}

/* The surroundings have the error of extrapolation, that of what walls send out, and that of beams and rays. Of the
 * last the square is a mean of two: from the sample of the surroundings alone, and from the samples of spheres and
 * walls. */
double fibrad_heat_surroundings_error(const fibrad_heat *heat, const fibrad_heat_errors *errors) {
    double halves = 0, changed = 0, area = 0, unseen = 0, residual = 0, few = 0;
    for (uint32_t b = heat->spheres; b < heat->bodies; b++) {
        const double outside = fibrad_heat_outside(heat, b);
        halves += outside * heat->samples.halves[b],
            changed += outside * (heat->solution.power[b] - heat->solution.coarse[b]);
        area += outside * spread_of(heat, b).area;
        residual += outside * heat->solution.unsettled[b];
        if (b < fibrad_heat_beyond(heat, 0))
            few += squared(outside * few_of_wall(heat, errors, b).rays * heat->solution.power[b]);
    }
    const double seen = errors->all.area > 0 ? fibrad_min(1, area / errors->all.area) : 0;
    for (uint32_t b = 0; b < heat->spheres && area > 0; b++)
        unseen += is_exact(heat, b) ? fibrad_heat_radiated_error(heat, errors, b) : unseen_error(heat, errors, b);
    const double rays = squared(RAY_ERROR) * errors->outside + outside_by_walls(heat, errors);
    return fibrad_sqrt(squared(extrapolation_error(heat, changed)) + squared(RESIDUAL_ERROR * residual) +
                       squared(seen * errors->walls) + unseen + few +
                       (squared(BEAM_ERROR * halves) + outside_by_spheres(heat, errors) + rays) / 2);
}

/* ---- temperatures ----------------------------------------------------------------------------------------------- */

/* Of an emission, from beams and rays, as the own sample tells. */
static double sampled_emission(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b, double area) {
    return sampled_error(heat, errors, b) / squared(area);
}

/* Of an emission, from extrapolation. */
static double changed_emission(const fibrad_heat *heat, uint32_t b) {
    return squared(extrapolation_error(heat, heat->sources.emission[b] - heat->solution.coarse_emission[b]));
}

/* Of an emission, from the steps to come. */
static double unsettled_emission(const fibrad_heat *heat, uint32_t b, double area) {
    const double eps = heat->sources.emissivity[b];
    return squared(RESIDUAL_ERROR * heat->solution.unsettled[b] / (eps > 0 ? eps * area : area));
}

/* Finds what the errors of unknown emissions have in common. If the sides of a mesh have temperatures of their own,
 * each patch counts by itself, since the sides exchange heat with each other. */
static void find_common(const fibrad_heat *heat, fibrad_heat_errors *errors) {
    double powers = 0, square = 0, distances[2] = {0, 0}, spheres = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const fibrad_heat_spread own = spread_of(heat, b);
        const int kind = b >= heat->spheres;
        if (!(own.area > 0)) continue;
        if (fibrad_heat_is_free(heat, b) || fibrad_heat_is_insulated(heat, b)) {
            errors->sampled[kind] += sampled_emission(heat, errors, b, own.area);
            distances[kind] += distance_of(errors, &own);
            if (kind == 0) errors->changed += changed_emission(heat, b), spheres++;
        } else {
            const double *excess = fibrad_heat_excess(heat, b), power = fibrad_abs(heat->solution.power[b]);
            if (excess == NULL) errors->given += power * heat->sources.emission[b], powers += power;
            for (uint32_t a = heat->first[b]; a < heat->first[b + 1] && excess != NULL; a++) {
                const double net = fibrad_abs(heat->solution.net[a]);
                errors->given += net * (heat->sources.emission[b] + excess[a - heat->first[b]]), powers += net;
            }
            if (b < fibrad_heat_beyond(heat, 0)) square += fibrad_heat_radiated_error(heat, errors, b);
        }
    }
    if (spheres > 0) errors->changed /= spheres;
    if (powers > 0) errors->given /= powers, errors->common = fibrad_sqrt(square) / powers;
    for (int kind = 0; kind < 2; kind++)
        if (distances[kind] > 0) errors->sampled[kind] /= distances[kind];
}

/* Of what a surface absorbs, per area: from beams and rays, as the mean of the own sample and of all samples; and what
 * all that are found have in common, the radiation of walls included. */
typedef struct absorbed_error {
    double own, common, walls;
} absorbed_error;

static absorbed_error absorbed_of(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b,
                                  const fibrad_heat_spread *own) {
    const double emission = fibrad_heat_is_insulated(heat, b) ? own->mean : heat->sources.emission[b];
    const bool meets = b >= heat->spheres && errors->meets[b - heat->spheres];
    const double few = meets ? few_error(heat, errors, b) : fibrad_heat_sent_back(heat, b) * squared(errors->few);
    return (absorbed_error){(sampled_emission(heat, errors, b, own->area) +
                             errors->sampled[b >= heat->spheres] * distance_of(errors, own)) /
                                2,
                            (squared(errors->common) + few) * squared(emission - errors->given),
                            squared(errors->walls / errors->all.area)};
}

static double slope_at(const fibrad_heat *heat, double t) { return 4 * heat->sources.sigma * t * t * t; }

double fibrad_heat_temperature_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t b, double t) {
    const double slope = slope_at(heat, t);
    const fibrad_heat_spread own = spread_of(heat, b);
    const double answer = answer_of(heat, b);
    const bool insulated = fibrad_heat_is_insulated(heat, b) || answer > 0;
    if (fibrad_heat_is_joined(heat, b)) return heat->contacts.error[b];
    if (!(fibrad_heat_is_free(heat, b) || insulated) || !(slope > 0) || !(own.area > 0)) return 0;
    const double eps = heat->sources.emissivity[b], held = fibrad_max(0, heat->sources.storage[b]);
    const double share = answer > 0 ? answer : held > 0 ? eps * own.area / (eps * own.area + held) : 1;
    const double changed =
        (insulated ? errors->changed : changed_emission(heat, b)) + unsettled_emission(heat, b, own.area);
    const absorbed_error absorbed = absorbed_of(heat, errors, b, &own);
    return fibrad_sqrt(changed + squared(share) * (absorbed.own + absorbed.common + absorbed.walls)) / slope;
}

double fibrad_heat_place_error(const fibrad_heat *heat, uint32_t b, double value, double patch, bool open) {
    const fibrad_scene *scene = heat->scene;
    const double centre[3] = {scene->x[b], scene->y[b], scene->z[b]}, coarse = PATCHES / heat->config.patches;
    const double further = fibrad_max(0, heat->solution.span[b].neighbours - 1.0);
    bool near = heat->triangles > 0 && scene->clear[b] < 2;
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        near = near || (scene->wall_area[k] > 0 && fibrad_walls_away(&scene->container, k, centre) < 2 * scene->r[b]);
    const double square = open ? coarse * squared(near ? NEAR_WALL_ERROR : OPEN_ERROR)
                               : squared(FACING_ERROR) + coarse * further * squared(NEIGHBOUR_ERROR);
    return fibrad_sqrt(squared(PLACE_ERROR * (value - patch)) + square * squared(value));
}

/* ---- contacts --------------------------------------------------------------------------------------------------- */

static double sign_of(uint32_t b, uint32_t number) {
    uint64_t mixed = ((uint64_t)b * SIGNS + number + 1) * UINT64_C(0x9e3779b97f4a7c15);
    mixed = (mixed ^ mixed >> 31) * UINT64_C(0xbf58476d1ce4e5b9);
    return mixed >> 63 ? 1 : -1;
}

/* Sets contacts.error to the errors of what joined surfaces absorb, and contacts.direction to the part of a common
 * error of radiation that their emissions follow. */
static void find_absorbed_errors(const fibrad_heat *heat, const fibrad_heat_errors *errors) {
    fibrad_contacts c = heat->contacts;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const fibrad_heat_spread own = spread_of(heat, b);
        c.error[b] = c.load[b] = 0;
        if (!fibrad_heat_is_joined(heat, b) || !(own.area > 0)) continue;
        c.load[b] = heat->sources.emissivity[b] * own.area;
        c.error[b] = c.load[b] * fibrad_sqrt(absorbed_of(heat, errors, b, &own).own);
    }
    fibrad_heat_sum_clumps(heat, c.load);
    fibrad_contact_warm(&c);
    fibrad_copy(c.direction, c.warming, heat->bodies * sizeof *c.direction);
    fibrad_heat_follow_leaders(heat, c.direction);
}

/* Sets contacts.supply to what errors of single surfaces make of all emissions: means over random signs. */
static void average_signs(const fibrad_heat *heat) {
    fibrad_contacts c = heat->contacts;
    fibrad_zero(c.supply, heat->bodies * sizeof *c.supply);
    for (uint32_t number = 0; number < SIGNS; number++) {
        for (uint32_t b = 0; b < heat->bodies; b++) c.load[b] = sign_of(b, number) * c.error[b];
        fibrad_heat_sum_clumps(heat, c.load);
        fibrad_contact_warm(&c);
        for (uint32_t b = 0; b < heat->bodies; b++) c.supply[b] += squared(c.warming[b]) / SIGNS;
    }
}

/* Gives the members of clumps the root mean square of their errors, by emissivity times area. */
static void average_members(const fibrad_heat *heat, double *error) {
    fibrad_contacts c = heat->contacts;
    if (!heat->clumps.some) return;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        c.load[b] = fibrad_heat_is_member(heat, b) ? heat->sources.emissivity[b] * spread_of(heat, b).area : 0;
        c.product[b] = c.load[b] * squared(error[b]);
    }
    fibrad_heat_sum_clumps(heat, c.load);
    fibrad_heat_sum_clumps(heat, c.product);
    for (uint32_t b = 0; b < heat->spheres; b++)
        if (c.load[b] > 0) error[b] = fibrad_sqrt(c.product[b] / c.load[b]);
    fibrad_heat_follow_leaders(heat, error);
}

/* Sets contacts.error to the errors of temperatures of joined surfaces, which contacts pass on to each other, and
 * contacts.supply to those of what other surfaces gain through contacts. */
static void find_joined_errors(const fibrad_heat *heat, const fibrad_heat_errors *errors) {
    const fibrad_contacts *c = &heat->contacts;
    find_absorbed_errors(heat, errors);
    average_signs(heat);
    fibrad_heat_follow_leaders(heat, c->supply);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double slope = slope_at(heat, fibrad_abs(c->temperature[b]));
        const fibrad_heat_spread own = spread_of(heat, b);
        c->error[b] = 0;
        if (!fibrad_heat_is_joined(heat, b) || !(slope > 0) || !(own.area > 0)) continue;
        const absorbed_error absorbed = absorbed_of(heat, errors, b, &own);
        const double changed = changed_emission(heat, b) + unsettled_emission(heat, b, own.area);
        c->error[b] =
            fibrad_sqrt(changed + c->supply[b] + squared(c->direction[b]) * (absorbed.common + absorbed.walls)) / slope;
    }
    average_members(heat, c->error);
    fibrad_zero(c->supply, heat->bodies * sizeof *c->supply);
    for (uint32_t k = 0; k < c->count; k++) {
        const uint32_t i = heat->end[c->first[k]], j = heat->end[c->second[k]];
        c->supply[i] += squared(c->conductance[k] * c->error[j]),
            c->supply[j] += squared(c->conductance[k] * c->error[i]);
    }
}

double fibrad_heat_flow_error(const fibrad_heat *heat, uint32_t k) {
    const fibrad_contacts *c = &heat->contacts;
    const uint32_t i = c->node[c->first[k]], j = c->node[c->second[k]];
    const double ends = squared(c->error[i]) + squared(c->error[j]),
                 times = i >= heat->spheres || j >= heat->spheres ? FLOW_AT_WALL : 1;
    return fibrad_sqrt(squared(times * c->conductance[k]) * ends +
                       (heat->spots.entering != NULL ? heat->spots.doubt[k] : 0));
}

void fibrad_heat_find_errors(const fibrad_heat *heat, fibrad_heat_errors *errors) {
    *errors = (fibrad_heat_errors){.all = spread_over(heat, 0, heat->patches)};
    errors->few = FEW_ON_SPHERES * heat->config.patches * heat->thin / (2.0 * heat->beams);
    errors->pool[1].samples = sample_all_rays(heat, errors);
    find_dim(heat, errors);
    find_sent(heat, errors);
    find_pools(heat, errors);
    find_common(heat, errors);
    if (heat->contacts.joins) find_joined_errors(heat, errors);
}
