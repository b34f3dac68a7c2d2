/* result.c - hands out powers and temperatures with their estimated errors. SPDX-License-Identifier: MIT
 *
 * Two differences tell the error of a sphere's power: that between even and odd beams, and that between the two levels
 * of patches. They are one sample of the error, which may be small by chance. It turns out that the errors of bodies of
 * one kind are what they exchange times a normal random number. So all samples of a kind together tell the error, too.
 * The square of the estimate is the mean of two squares: that from the body's own sample, and that from all samples.
 * The difference between the two levels of a wall is smooth. It is taken as it is. */
#include "base/constants.h"
#include "heat/fine.h"
#include "heat/wall_patch.h"
#include "scene/walls.h"

/* Errors over the quantities from which they are estimated. Measured: docs/methods_heat.md section 9. */
#define PATCH_ERROR    .2 /* with PATCHES */
#define PATCHES        96.0
#define UNEVEN         50 /* 1/(2 k*) of a sphere for whose power this error is half as large again */
#define WALL_PATCHES   .5 /* factor for walls */
#define BEAM_ERROR     .7
#define LONE_ERROR     1.2     /* times the share of spheres that only even or only odd directions meet */
#define UNSEEN_ERROR   .25     /* over what one direction brings */
#define SHARE_ERROR    0x1p-25 /* of what a sphere exchanges: shares of pencils are floats */
#define RAY_ERROR      1.75
#define RAY_SAMPLES    16  /* largest number of samples of a mesh */
#define FEW_ERROR      .25 /* times patches over beams: if few beams leave a patch, it sends light back along the same */
#define FEW_SEEN       1.3 /* the same for walls that a sphere sees, whose beams are less even */
#define FEW_WALLS      .65 /* the same for walls themselves */
#define BACK_LEFT      .2  /* part of the error of walls that send back all, which larger exchange areas leave */
#define SPOT_ERROR     .7
#define RESIDUAL_ERROR 2    /* times what the steps to come would change */
#define SPAN_ERROR     .015 /* of the extremes of a surface, over their difference from its mean */
#define SPAN_OPEN      .07  /* the same, with PATCHES, where no neighbour is near */
#define SPAN_WALL      .08  /* the same if a wall may be near */
#define SPAN_CROWD                                                                                                     \
    .014 /* times the root of the number of further neighbours, with PATCHES: they are lights of patches */
#define SPOT_EXTREME .05 /* of spots of contacts, over their difference from the mean of the surface */
#define SPAN_CHANGE  .05 /* error over the difference from the patch */
#define SAMPLES      3   /* if a kind has fewer samples, those of the other kind are taken as well */

static double squared(double x) { return x * x; }

/* The area of patches, and mean and variance of their radiosities. */
typedef struct heat_spread {
    double area, mean, variance;
} heat_spread;

/* Of all spheres, or of all walls: number of samples, sum of squared errors, sum of squares of what they exchange. */
typedef struct error_pool {
    double samples, errors, exchanges;
} error_pool;

/* Squares of the differences between even and odd rays. They are sums over all walls that send rays. The rays of a mesh
 * are divided into stretches, which have sequences of their own. */
typedef struct ray_samples {
    double squares[FIBRAD_HEAT_OTHERS]; /* of the power of each body that is not a sphere */
    double outside;                     /* of the power of the surroundings */
    double more;                        /* number of samples minus number of walls */
} ray_samples;

typedef struct heat_errors {
    ray_samples rays;
    heat_spread all;
    double few;         /* error over power of a sphere among spheres that reflect all, from few beams per patch */
    double dim[2];      /* mean reflectivity by area of spheres, and of walls */
    double walls;       /* error of what walls send out */
    error_pool pool[2]; /* of spheres, of walls */
} heat_errors;

static heat_spread spread_over(const fibrad_heat *heat, uint32_t begin, uint32_t end) {
    heat_spread s = {0, 0, 0};
    for (uint32_t a = begin; a < end; a++)
        s.area += heat->solution.area[a], s.mean += heat->solution.area[a] * heat->solution.radiosity[a];
    if (!(s.area > 0)) return s;
    s.mean /= s.area;
    for (uint32_t a = begin; a < end; a++)
        s.variance += heat->solution.area[a] / s.area * squared(heat->solution.radiosity[a] - s.mean);
    return s;
}

static heat_spread spread_of(const fibrad_heat *heat, uint32_t b) {
    return spread_over(heat, heat->first[b], heat->first[b + 1]);
}

/* What a body exchanges: emissivity times area times the root mean square difference of all radiosities from its own.
 */
static double exchange_of(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const heat_spread own = spread_of(heat, b);
    return heat->sources.emissivity[b] * own.area *
           fibrad_sqrt(errors->all.variance + squared(own.mean - errors->all.mean));
}

/* The number of the body of a patch, counted from the first body that is not a sphere. The search begins at body
 * `guess`, since rays are in the order of the bodies. */
static uint32_t other_of_patch(const fibrad_heat *heat, uint32_t patch, uint32_t guess) {
    const uint32_t *first = heat->first + heat->spheres, bodies = heat->bodies - heat->spheres;
    while (patch < first[guess] || patch >= first[guess + 1]) guess = guess + 1 < bodies ? guess + 1 : 0;
    return guess;
}

/* Adds the difference between the even and the odd rays of a stretch to the samples. */
static void sample_rays(const fibrad_heat *heat, uint32_t begin, uint32_t end, ray_samples *samples) {
    const uint32_t bodies = heat->bodies - heat->spheres;
    double half[FIBRAD_HEAT_OTHERS] = {0}, outside = 0;
    uint32_t from = 0, to = 0;
    for (uint32_t k = begin; k < end; k++) {
        const fibrad_heat_ray *ray = &heat->ray[k];
        if (ray->area == 0) continue;
        from = other_of_patch(heat, ray->from, from), to = other_of_patch(heat, ray->to, to);
        const double flow = ray->area * (heat->solution.source[ray->to] - heat->solution.source[ray->from]);
        half[from] += k % 2 ? -flow : flow, half[to] -= k % 2 ? -flow : flow;
    }
    for (uint32_t b = 0; b < bodies; b++) {
        samples->squares[b] += squared(half[b]);
        outside += fibrad_heat_outside(heat, heat->spheres + b) * half[b];
    }
    samples->outside += squared(outside);
}

/* The number of samples into which the rays of a slot are divided. */
static uint32_t stretches_of(const fibrad_heat *heat, uint32_t slot) {
    if (slot < FIBRAD_MESHES) return 1;
    const uint32_t *side = heat->scene->mesh.first + (slot - FIBRAD_MESHES);
    return side[1] - side[0] < RAY_SAMPLES ? 1 : RAY_SAMPLES;
}

static void sample_all_rays(const fibrad_heat *heat, ray_samples *samples) {
    *samples = (ray_samples){{0}, 0, 0};
    for (uint32_t slot = 0; slot < FIBRAD_MESHES + heat->meshes; slot++) {
        const fibrad_heat_rays *sent = &heat->sent[slot];
        const uint32_t stretches = stretches_of(heat, slot);
        samples->more += stretches - 1;
        for (uint32_t k = 0; k < stretches; k++)
            sample_rays(heat, sent->first + (uint32_t)((uint64_t)sent->count * k / stretches),
                        sent->first + (uint32_t)((uint64_t)sent->count * (k + 1) / stretches), samples);
    }
}

/* The square of the error of what rays bring a body. */
static double missed_by_rays(const heat_errors *errors, const fibrad_heat *heat, uint32_t b) {
    return b >= heat->spheres ? squared(RAY_ERROR) * errors->rays.squares[b - heat->spheres] : 0;
}

/* The square of the error of what beams bring a body, over the squared difference between even and odd beams.
 * Directions are evenly spread. So the error of a sphere that several of them meet is smaller than the difference.
 * Whether one direction meets a far sphere or none does is chance. */
static double beam_error(const fibrad_heat *heat, uint32_t b) {
    const fibrad_heat_seen *seen = &heat->samples.seen[b];
    const double lone = b < heat->spheres && seen->squares > 0 ? seen->lone / seen->squares : 0;
    return squared(BEAM_ERROR) + squared(LONE_ERROR * lone);
}

/* The square of the error of what beams and rays bring a body. */
static double missed_of(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    return beam_error(heat, b) * squared(heat->samples.halves[b]) + missed_by_rays(errors, heat, b);
}

/* The square of an error that no beam tells: between the directions that meet no sphere there may be spheres. If all
 * spheres were asked for, only rounding is left. */
static double unseen_error(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const double open = fibrad_max(0, 1 - heat->samples.seen[b].met / heat->beams);
    const double unseen = heat->pencils.row[b].told ? 0 : open * squared(UNSEEN_ERROR / heat->config.directions);
    return (unseen + squared(SHARE_ERROR)) * squared(exchange_of(heat, errors, b));
}

/* The error that remains after extrapolation has changed a value by `change`. It is larger if there are few patches. */
static double extrapolation_error(const fibrad_heat *heat, double change) {
    return PATCH_ERROR * fibrad_sqrt(fibrad_sqrt(PATCHES / heat->config.patches)) * change;
}

/* A sphere that conducts badly has spots smaller than patches where it nearly touches others. */
static double patch_error(const fibrad_heat *heat, uint32_t b) {
    const double change = extrapolation_error(heat, heat->solution.power[b] - heat->solution.coarse[b]);
    if (b >= heat->spheres) return WALL_PATCHES * change;
    const double uneven = heat->sources.unevenness[b];
    return (1 + uneven / (uneven + UNEVEN)) * change;
}

/* The square of the error over the power of a sphere that comes from few beams on each patch of spheres and walls. */
static double few_of_sphere(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const double *reflected = heat->samples.seen[b].reflected;
    const double walls =
        reflected[1] > 0 ? FEW_SEEN * reflected[1] / heat->beams / (heat->density[b] * heat->patch_area) : 0;
    return reflected[0] / heat->beams * squared(errors->few) + squared(walls);
}

/* The same for a wall, which beams of spheres and rays meet. Half of the rays are its own. */
typedef struct few_links {
    double rays, beams; /* parts of the error over the power */
} few_links;

static few_links few_of_wall(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const uint32_t k = b - heat->spheres, slot = k < FIBRAD_WALLS ? k : FIBRAD_MESHES + (k - FIBRAD_WALLS);
    const fibrad_heat_rays *sent = &heat->sent[slot];
    const double area = spread_of(heat, b).area;
    double rays = 0;
    for (uint32_t r = sent->first; r < sent->first + sent->count; r++) rays += 2 * heat->ray[r].area;
    const double share = area > 0 ? fibrad_min(1, rays / area) : 0;
    return (few_links){.rays =
                           share > 0 ? FEW_WALLS * share * errors->dim[1] / (2 * sent->density * heat->patch_area) : 0,
                       .beams = FEW_WALLS * (1 - share) * errors->dim[0] * heat->config.patches / heat->beams};
}

/* The square of the error over the power of any body, from few beams or rays on each patch. */
static double few_of(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    if (b < heat->spheres) return few_of_sphere(heat, errors, b);
    const few_links few = few_of_wall(heat, errors, b);
    return squared(few.rays + few.beams);
}

/* The square of the error that a body's own sample tells, with that of the walls that it sees. */
static double own_error(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const double eps = heat->sources.emissivity[b];
    const double few = few_of(heat, errors, b);
    const double seen = errors->all.area > 0 ? eps * spread_of(heat, b).area / errors->all.area : 0;
    const double sphere = b < heat->spheres ? squared(patch_error(heat, b)) + unseen_error(heat, errors, b) : 0;
    return squared(eps) * missed_of(heat, errors, b) + sphere + few * squared(heat->solution.power[b]) +
           squared(seen * errors->walls) + squared(RESIDUAL_ERROR * heat->solution.unsettled[b]);
}

/* The error from light that goes back and forth between a sphere and a mesh whose patches are too large. */
static double spot_error(const fibrad_heat *heat, uint32_t b) {
    const uint32_t mesh = fibrad_heat_body(heat, FIBRAD_MESHES);
    double back = 0;
    if (b >= heat->spheres || heat->solution.group > 1) return 0;
    for (uint32_t m = 0; m < heat->meshes; m++) back = fibrad_max(back, 1 - heat->sources.emissivity[mesh + m]);
    return SPOT_ERROR * back * fibrad_heat_comes_back(heat, b) * heat->solution.power[b];
}

static heat_errors errors_of(const fibrad_heat *heat) {
    const uint32_t end = fibrad_heat_beyond(heat, 0); /* end of the spheres and walls */
    double areas[2] = {0, 0};
    heat_errors errors = {.all = spread_over(heat, 0, heat->patches)};
    sample_all_rays(heat, &errors.rays);
    if (heat->solution.group == 1) errors.few = FEW_ERROR * heat->config.patches * heat->thin / (2.0 * heat->beams);
    for (uint32_t b = 0; b < end; b++) {
        const int kind = b >= heat->spheres;
        const double area = spread_of(heat, b).area;
        areas[kind] += area;
        errors.dim[kind] += area * (fibrad_heat_reflects(heat, b) ? BACK_LEFT : fibrad_heat_sent_back(heat, b));
    }
    for (int kind = 0; kind < 2; kind++)
        if (areas[kind] > 0) errors.dim[kind] /= areas[kind];
    for (uint32_t b = heat->spheres; b < end; b++)
        errors.walls +=
            squared(heat->sources.hold[b] >= 0 ? 1 : 1 - heat->sources.emissivity[b]) * missed_of(heat, &errors, b);
    errors.walls = fibrad_sqrt(errors.walls + squared(RESIDUAL_ERROR * heat->solution.sent_unsettled));
    for (uint32_t b = 0; b < end; b++) {
        error_pool *pool = &errors.pool[b >= heat->spheres];
        const double exchange = exchange_of(heat, &errors, b);
        if (!(exchange > 0) || heat->sources.hold[b] >= 0) continue;
        pool->samples++, pool->errors += own_error(heat, &errors, b), pool->exchanges += squared(exchange);
    }
    errors.pool[1].samples += errors.rays.more;
    return errors;
}

/* The square of the estimated error of a body's power. */
static double power_error_of(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    if (heat->sources.hold[b] >= 0) return 0; /* the power is given */
    const double exchange = exchange_of(heat, errors, b);
    const int own = b >= heat->spheres;
    double sum = 0, samples = 0;
    for (int kind = 0; kind < 2; kind++) {
        const error_pool *pool = &errors->pool[kind];
        if (!(pool->exchanges > 0)) continue;
        const double weight = kind == own ? pool->samples : fibrad_max(0, SAMPLES - errors->pool[own].samples);
        sum += weight * pool->errors / pool->exchanges, samples += weight;
    }
    const double pooled = samples > 0 ? sum / samples * squared(exchange) : 0;
    const double smooth = b < heat->spheres ? spot_error(heat, b) : patch_error(heat, b);
    return exchange > 0 ? squared(smooth) + (own_error(heat, errors, b) + pooled) / 2 : 0;
}

/* The area for which the rays between walls and surroundings stand. */
static double rays_outside(const fibrad_heat *heat) {
    bool outside[FIBRAD_HEAT_OTHERS] = {0};
    const uint32_t bodies = heat->bodies - heat->spheres;
    double area = 0;
    uint32_t from = 0, to = 0;
    for (uint32_t k = 0; k < bodies; k++) outside[k] = fibrad_heat_outside(heat, heat->spheres + k) > 0;
    for (uint32_t r = 0; r < heat->rays; r++) {
        const fibrad_heat_ray *ray = &heat->ray[r];
        if (ray->area == 0) continue;
        from = other_of_patch(heat, ray->from, from), to = other_of_patch(heat, ray->to, to);
        if (outside[from] != outside[to]) area += ray->area;
    }
    return area;
}

/* The square of the error of the power that spheres give to the surroundings. Each sphere is a sample. If fewer than
 * SAMPLES spheres see the surroundings, the errors of their own powers are taken as well. */
static double missed_by_spheres(const fibrad_heat *heat, const heat_errors *errors) {
    double square = 0, spheres = 0, all = 0;
    for (uint32_t b = 0; b < heat->spheres; b++)
        square += beam_error(heat, b) * squared(heat->samples.seen[b].escaping),
            spheres += heat->samples.seen[b].escaping != 0;
    if (spheres == 0 || spheres >= SAMPLES) return square;
    for (uint32_t b = 0; b < heat->spheres; b++) all += power_error_of(heat, errors, b);
    return (spheres * square + (SAMPLES - spheres) * all) / SAMPLES;
}

/* The square of the error of the power that walls give to the surroundings. Its relative error is taken to be that of
 * what walls exchange with each other. */
static double missed_by_walls(const fibrad_heat *heat, const heat_errors *errors) {
    double missed = 0, exchanges = 0;
    for (uint32_t b = heat->spheres; b < fibrad_heat_beyond(heat, 0); b++)
        missed += squared(heat->sources.emissivity[b]) * missed_by_rays(errors, heat, b),
            exchanges += squared(exchange_of(heat, errors, b));
    if (!(exchanges > 0)) return 0;
    return missed / exchanges * squared(rays_outside(heat)) * (errors->all.variance + squared(errors->all.mean));
}

/* The square of the estimated error of the power of the surroundings. It has the error of extrapolation, that of what
 * walls send out, and that of beams and rays. Of the last the square is a mean of two: from the sample of the
 * surroundings alone, and from the samples of spheres and walls. */
static double surroundings_error_of(const fibrad_heat *heat, const heat_errors *errors) {
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
    for (uint32_t b = 0; b < heat->spheres && area > 0; b++) unseen += unseen_error(heat, errors, b);
    const double rays = squared(RAY_ERROR) * errors->rays.outside + missed_by_walls(heat, errors);
    return squared(extrapolation_error(heat, changed)) + squared(RESIDUAL_ERROR * residual) +
           squared(seen * errors->walls) + unseen + few +
           (squared(BEAM_ERROR * halves) + missed_by_spheres(heat, errors) + rays) / 2;
}

/* The estimated error of the power of a body, contacts included. */
static double whole_power_error(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const double square = power_error_of(heat, errors, b);
    if (heat->contacts.count == 0 || heat->sources.hold[b] >= 0) return fibrad_sqrt(square);
    return fibrad_sqrt(square + heat->contacts.supply[b]);
}

static void read_errors(const fibrad_heat *heat, fibrad_heat_result *result) {
    const heat_errors errors = errors_of(heat);
    const double spheres = fibrad_max(1, heat->spheres);
    double patches = 0, all = 0;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const double square = power_error_of(heat, &errors, b);
        if (result->power_error != NULL) result->power_error[heat->order[b]] = whole_power_error(heat, &errors, b);
        if (square > 0) patches += squared(patch_error(heat, b)) + squared(spot_error(heat, b));
        all += square;
    }
    for (uint32_t k = 0; k < heat->given_walls && result->wall_error != NULL; k++)
        result->wall_error[k] = whole_power_error(heat, &errors, fibrad_heat_body(heat, heat->slot[k]));
    result->surroundings_error = fibrad_sqrt(surroundings_error_of(heat, &errors));
    for (uint32_t k = 0; k < heat->given_walls && result->wall_area != NULL; k++)
        result->wall_area[k] = heat->slot[k] < FIBRAD_MESHES ? fibrad_heat_wall_area(heat, heat->slot[k])
                                                             : fibrad_scene_wall_area(heat->scene, k);
    patches = fibrad_min(patches, all);
    result->error_patches = fibrad_sqrt(patches / spheres);
    result->error_beams = fibrad_sqrt((all - patches) / spheres);
}

static bool is_found(const fibrad_heat *heat, uint32_t b) {
    return heat->sources.hold[b] >= 0 || fibrad_heat_is_insulated(heat, b);
}

/* The square of the error of a body's emission from beams, as its own sample tells. */
static double missed_emission(const fibrad_heat *heat, const heat_errors *errors, uint32_t b, double area) {
    return missed_of(heat, errors, b) / squared(area);
}

/* The error of a body's emission that remains after extrapolation. */
static double changed_emission(const fibrad_heat *heat, uint32_t b) {
    return extrapolation_error(heat, heat->sources.emission[b] - heat->solution.coarse_emission[b]);
}

/* The error of a body's emission that later steps of the search would take away. */
static double unsettled_emission(const fibrad_heat *heat, uint32_t b, double area) {
    const double eps = heat->sources.emissivity[b];
    return RESIDUAL_ERROR * heat->solution.unsettled[b] / (eps > 0 ? eps * area : area);
}

/* The mean square difference of all radiosities from the body's own. */
static double distance_of(const heat_errors *errors, const heat_spread *own) {
    return errors->all.variance + squared(own->mean - errors->all.mean);
}

/* All emissions that are found have an error in common: if the powers of the bodies with given emissions are wrong, all
 * differences between found and given emissions are wrong by the same factor. */
typedef struct heat_level {
    double given;     /* mean of given emissions, weighted by power */
    double error;     /* the relative error in common */
    double missed[2]; /* of spheres, of walls: sum of missed_emission over sum of distance_of */
    double changed;   /* mean square of changed_emission of spheres, which also serves insulated walls */
} heat_level;

static heat_level level_found(const fibrad_heat *heat, const heat_errors *errors) {
    heat_level level = {0, 0, {0, 0}, 0};
    double powers = 0, square = 0, distances[2] = {0, 0}, spheres = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const heat_spread own = spread_of(heat, b);
        if (!(own.area > 0)) continue;
        if (is_found(heat, b)) {
            const int kind = b >= heat->spheres;
            level.missed[kind] += missed_emission(heat, errors, b, own.area),
                distances[kind] += distance_of(errors, &own);
            if (kind == 0) level.changed += squared(changed_emission(heat, b)), spheres++;
        } else {
            const double power = fibrad_abs(heat->solution.power[b]);
            level.given += power * heat->sources.emission[b], powers += power;
            if (b < fibrad_heat_beyond(heat, 0)) square += power_error_of(heat, errors, b);
        }
    }
    if (spheres > 0) level.changed /= spheres;
    if (powers > 0) level.given /= powers, level.error = fibrad_sqrt(square) / powers;
    for (int kind = 0; kind < 2; kind++)
        if (distances[kind] > 0) level.missed[kind] /= distances[kind];
    return level;
}

/* The squares of the errors of what a body absorbs per area: of beams, as the mean of the squares from its own sample
 * and from all samples, and of what walls send out; and the error that it has in common with all others. */
typedef struct heat_missed {
    double own, together;
} heat_missed;

static heat_missed missed_at(const fibrad_heat *heat, const heat_errors *errors, const heat_level *level, uint32_t b,
                             const heat_spread *own) {
    const double emission = fibrad_heat_is_insulated(heat, b) ? own->mean : heat->sources.emission[b];
    const double missed =
        (missed_emission(heat, errors, b, own->area) + level->missed[b >= heat->spheres] * distance_of(errors, own)) /
        2;
    const double together = (squared(level->error) + fibrad_heat_sent_back(heat, b) * squared(errors->few)) *
                            squared(emission - level->given);
    return (heat_missed){missed, together};
}

/* The estimated error of a temperature that was found. The error of its emission has five parts: that of extrapolation;
 * the residual; that of beams; that of what walls send out; and that which all have in common. */
static double temperature_error_of(const fibrad_heat *heat, const heat_errors *errors, const heat_level *level,
                                   uint32_t b, double temperature) {
    const double slope = 4 * heat->sources.sigma * temperature * temperature * temperature;
    const heat_spread own = spread_of(heat, b);
    if (fibrad_heat_is_joined(heat, b)) return heat->contacts.error[b];
    if (!is_found(heat, b) || !(slope > 0) || !(own.area > 0)) return 0;
    const double eps = heat->sources.emissivity[b], held = fibrad_max(0, heat->sources.hold[b]);
    const double share = held > 0 ? eps * own.area / (eps * own.area + held) : 1;
    const double changed = (fibrad_heat_is_insulated(heat, b) ? level->changed : squared(changed_emission(heat, b))) +
                           squared(unsettled_emission(heat, b, own.area));
    const heat_missed missed = missed_at(heat, errors, level, b, &own);
    const double walls = squared(errors->walls / errors->all.area);
    return fibrad_sqrt(changed + squared(share) * (missed.own + missed.together + walls)) / slope;
}

/* Numbers of random signs from which the errors that contacts pass on are found. */
#define PROBES 8u

static double sign_of(uint32_t b, uint32_t probe) {
    uint64_t mixed = ((uint64_t)b * PROBES + probe + 1) * UINT64_C(0x9e3779b97f4a7c15);
    mixed = (mixed ^ mixed >> 31) * UINT64_C(0xbf58476d1ce4e5b9);
    return mixed >> 63 ? 1 : -1;
}

/* Sets contacts.error to the errors of what joined bodies absorb, and contacts.direction to the part of a common error
 * of radiation that the emissions of joined bodies follow. */
static void find_absorbed_errors(const fibrad_heat *heat, const heat_errors *errors, const heat_level *level) {
    fibrad_contacts c = heat->contacts;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const heat_spread own = spread_of(heat, b);
        c.error[b] = c.load[b] = 0;
        if (!fibrad_heat_is_joined(heat, b) || !(own.area > 0)) continue;
        const double absorbs = heat->sources.emissivity[b] * own.area;
        c.error[b] = absorbs * fibrad_sqrt(missed_at(heat, errors, level, b, &own).own);
        c.load[b] = absorbs;
    }
    fibrad_contact_warm(&c);
    fibrad_copy(c.direction, c.warming, heat->bodies * sizeof *c.direction);
}

/* Sets contacts.supply to the squares of the errors of emissions that come from errors of what single bodies absorb:
 * means over random signs of these errors. */
static void probe_joined(const fibrad_heat *heat) {
    fibrad_contacts c = heat->contacts;
    fibrad_zero(c.supply, heat->bodies * sizeof *c.supply);
    for (uint32_t probe = 0; probe < PROBES; probe++) {
        for (uint32_t b = 0; b < heat->bodies; b++) c.load[b] = sign_of(b, probe) * c.error[b];
        fibrad_contact_warm(&c);
        for (uint32_t b = 0; b < heat->bodies; b++) c.supply[b] += squared(c.warming[b]) / PROBES;
    }
}

/* Finds the errors of temperatures of joined bodies, which contacts pass on to each other. Then contacts.supply has the
 * squares of the errors of what other bodies gain through contacts. */
static void find_joined_errors(const fibrad_heat *heat) {
    const heat_errors errors = errors_of(heat);
    const heat_level level = level_found(heat, &errors);
    const fibrad_contacts *c = &heat->contacts;
    const double walls = squared(errors.walls / errors.all.area);
    find_absorbed_errors(heat, &errors, &level);
    probe_joined(heat);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double t = fibrad_abs(c->temperature[b]), slope = 4 * heat->sources.sigma * t * t * t;
        const heat_spread own = spread_of(heat, b);
        c->error[b] = 0;
        if (!fibrad_heat_is_joined(heat, b) || !(slope > 0) || !(own.area > 0)) continue;
        const double common = missed_at(heat, &errors, &level, b, &own).together + walls;
        const double changed = squared(changed_emission(heat, b)) + squared(unsettled_emission(heat, b, own.area));
        c->error[b] = fibrad_sqrt(changed + c->supply[b] + squared(c->direction[b]) * common) / slope;
    }
    fibrad_zero(c->supply, heat->bodies * sizeof *c->supply);
    for (uint32_t k = 0; k < c->count; k++) {
        const uint32_t i = c->node[c->first[k]], j = c->node[c->second[k]];
        c->supply[i] += squared(c->conductance[k] * c->error[j]),
            c->supply[j] += squared(c->conductance[k] * c->error[i]);
    }
}

/* A temperature and its error. */
typedef struct measured {
    double value, error;
} measured;

/* The temperature in the centre of a sphere. It is q r^2/(6 k) above the mean of the surface, for a source of q per
 * volume that is uniform inside. Such a source gives off the net power and the light that is absorbed. */
static measured centre_of(const fibrad_heat *heat, uint32_t b, measured surface, double power_error) {
    const double slope = 1 / (8 * FIBRAD_PI * heat->scene->r[b] * heat->sources.conductivity[b]);
    const double gained = heat->solution.power[b] + fibrad_heat_conducted(heat, b) + fibrad_heat_absorbed(heat, b);
    return (measured){surface.value - slope * gained,
                      fibrad_sqrt(squared(surface.error) + squared(slope * power_error))};
}

/* Whether a plane or the cylinder is as near to a sphere as a neighbour that is looked at in rings. */
static bool is_near_wall(const fibrad_heat *heat, uint32_t b) {
    const fibrad_scene *scene = heat->scene;
    const double centre[3] = {scene->x[b], scene->y[b], scene->z[b]};
    bool near = heat->triangles > 0 && scene->clear[b] < 2;
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        near = near || (scene->wall_area[k] > 0 && fibrad_walls_away(&scene->container, k, centre) < 2 * scene->r[b]);
    return near;
}

/* The temperature of the hottest or coldest place of a sphere minus the mean of its surface. value, patch: emissions of
 * this place and of the patch that is hottest or coldest. open: the place does not face a neighbour, so patches tell
 * its light. */
static measured surface_extreme(const fibrad_heat *heat, uint32_t b, double value, double patch, bool open) {
    const double t = heat->sources.temperature[b], slope = 4 * heat->sources.sigma * t * t * t;
    const double coarse = PATCHES / heat->config.patches;
    const double crowd = fibrad_max(0, heat->solution.span[b].neighbours - 1.0);
    const double square = open ? coarse * squared(is_near_wall(heat, b) ? SPAN_WALL : SPAN_OPEN)
                               : squared(SPAN_ERROR) + coarse * crowd * squared(SPAN_CROWD);
    if (!fibrad_heat_conducts(heat, b)) return (measured){0, 0};
    return (measured){value / slope,
                      fibrad_sqrt(squared(SPAN_CHANGE * (value - patch)) + square * squared(value)) / slope};
}

/* Hands out the temperatures on the surface and in the centre of a sphere. */
static void read_inside(const fibrad_heat *heat, uint32_t b, measured mean, double power_error,
                        const fibrad_heat_result *result) {
    const fibrad_heat_span *span = &heat->solution.span[b];
    const uint32_t i = heat->order[b];
    measured low = surface_extreme(heat, b, span->least, span->low, span->open_low),
             high = surface_extreme(heat, b, span->largest, span->high, span->open_high);
    const measured centre = centre_of(heat, b, mean, power_error);
    if (span->coldest_spot < low.value)
        low = (measured){span->coldest_spot, fibrad_max(low.error, -SPOT_EXTREME * span->coldest_spot)};
    if (span->hottest_spot > high.value)
        high = (measured){span->hottest_spot, fibrad_max(high.error, SPOT_EXTREME * span->hottest_spot)};
    const double worst = fibrad_max(low.error, high.error);
    if (result->least_temperature != NULL) result->least_temperature[i] = mean.value + low.value;
    if (result->largest_temperature != NULL) result->largest_temperature[i] = mean.value + high.value;
    if (result->surface_error != NULL) result->surface_error[i] = fibrad_sqrt(squared(mean.error) + squared(worst));
    if (result->centre_temperature != NULL) result->centre_temperature[i] = centre.value;
    if (result->centre_error != NULL) result->centre_error[i] = centre.error;
}

/* The temperature at which a black wall would emit what an insulated wall sends back. */
static double insulated_temperature(const fibrad_heat *heat, uint32_t b) {
    return fibrad_heat_temperature(heat, fibrad_heat_mean(heat, b, heat->solution.radiosity));
}

/* Hands out temperatures and their errors. Returns whether all unknown ones were found. */
static bool read_temperatures(const fibrad_heat *heat, const fibrad_heat_result *result) {
    const heat_errors errors = errors_of(heat);
    const heat_level level = level_found(heat, &errors);
    bool found = true;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const uint32_t i = heat->order[b];
        if (heat->sources.hold[b] >= 0) found = found && heat->sources.temperature[b] >= 0;
        const double t = heat->sources.temperature[b];
        const measured mean = {t, temperature_error_of(heat, &errors, &level, b, t)};
        if (result->temperature != NULL) result->temperature[i] = t;
        if (result->temperature_error != NULL) result->temperature_error[i] = mean.error;
        read_inside(heat, b, mean, fibrad_sqrt(power_error_of(heat, &errors, b)), result);
    }
    for (uint32_t k = 0; k < heat->given_walls; k++) {
        const uint32_t b = fibrad_heat_body(heat, heat->slot[k]);
        if (heat->sources.hold[b] >= 0) found = found && heat->sources.temperature[b] >= 0;
        const double t =
            fibrad_heat_is_insulated(heat, b) ? insulated_temperature(heat, b) : heat->sources.temperature[b];
        if (result->wall_temperature != NULL) result->wall_temperature[k] = t;
        if (result->wall_temperature_error != NULL)
            result->wall_temperature_error[k] = temperature_error_of(heat, &errors, &level, b, t);
    }
    return found;
}

/* The result for the power of a slot. If the slot is an opening or empty: that of the surroundings. */
static double *power_of_slot(const fibrad_heat *heat, uint32_t slot, fibrad_heat_result *result) {
    for (uint32_t b = 0; b < heat->given_walls; b++)
        if (heat->slot[b] == slot) return &result->wall_power[b];
    return &result->surroundings_power;
}

/* A net flow, and the area for which its rays stand. */
typedef struct patch_flow {
    double net, area;
} patch_flow;

/* The flow from the patches of the wall that faces wall k to where wall k goes on beyond its patches. */
static patch_flow flow_of_facing(const fibrad_heat *heat, uint32_t k) {
    const uint32_t facing = fibrad_heat_facing(heat, k), a = heat->first[fibrad_heat_beyond(heat, k)];
    patch_flow flow = {0, 0};
    if (facing == FIBRAD_WALLS) return flow;
    const uint32_t body = fibrad_heat_body(heat, facing);
    for (uint32_t n = 0; n < heat->rays; n++) {
        const fibrad_heat_ray ray = heat->ray[n];
        if (ray.to != a || ray.from < heat->first[body] || ray.from >= heat->first[body + 1]) continue;
        flow.net +=
            fibrad_heat_ray_area(heat, &ray) * (heat->solution.radiosity[ray.from] - heat->solution.radiosity[a]);
        flow.area += ray.area;
    }
    return flow;
}

/* Shares out the power that arrives beyond the patches of wall k. Wall k gets what it absorbs, and what it faces gets
 * the rest. The flow between the patches of the facing wall and this place is left out of that: for both walls together
 * such flows add up to about 0, so each wall gets half of them. The powers of a pair are then those of its patches. */
static void read_beyond(const fibrad_heat *heat, uint32_t k, fibrad_heat_result *result) {
    const uint32_t beyond = fibrad_heat_beyond(heat, k), a = heat->first[beyond];
    if (a == heat->first[beyond + 1]) return;
    const patch_flow pair = flow_of_facing(heat, k);
    const double less = heat->solution.radiosity[a] - heat->sources.wall_emission[k],
                 net = heat->solution.net[a] - pair.net;
    const double taken = fibrad_heat_taken_beyond(heat, k) * (net + (heat->solution.area[a] - pair.area) * less);
    *power_of_slot(heat, k, result) += taken + pair.net / 2;
    *power_of_slot(heat, fibrad_heat_facing(heat, k), result) += heat->solution.power[beyond] - taken - pair.net / 2;
}

/* Hands out what contacts conduct. The powers of bodies are added later, those of spheres here. */
static void read_contacts(const fibrad_heat *heat, fibrad_heat_result *result) {
    const fibrad_contacts *c = &heat->contacts;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        if (c->count > 0) result->power[heat->order[b]] += c->gain[b];
        if (result->conducted != NULL) result->conducted[heat->order[b]] = fibrad_heat_conducted(heat, b);
    }
    for (uint32_t k = 0; k < heat->given_walls && result->wall_conducted != NULL; k++)
        result->wall_conducted[k] = fibrad_heat_conducted(heat, fibrad_heat_body(heat, heat->slot[k]));
    for (uint32_t k = 0; k < c->count && result->contact_flow != NULL; k++)
        result->contact_flow[k] =
            c->conductance[k] * (c->temperature[c->node[c->first[k]]] - c->temperature[c->node[c->second[k]]]) +
            (heat->spots.entering != NULL ? heat->spots.offset[k] : 0);
}

int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result) {
    if (heat == NULL || result == NULL || (heat->spheres > 0 && result->power == NULL)) return FIBRAD_E_ARGUMENT;
    if (heat->given_walls > 0 && result->wall_power == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase != FIBRAD_HEAT_DONE || !fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    const uint32_t spheres = heat->spheres, open = heat->bodies - 1;
    for (uint32_t b = 0; b < spheres; b++) result->power[heat->order[b]] = heat->solution.power[b];
    read_contacts(heat, result);
    result->surroundings_power = heat->solution.power[open];
    for (uint32_t b = 0; b < heat->given_walls; b++) {
        const uint32_t own = fibrad_heat_body(heat, heat->slot[b]);
        result->wall_power[b] = heat->solution.power[own];
        if (heat->contacts.count > 0) result->wall_power[b] += heat->contacts.gain[own];
        if (result->wall_absorbed != NULL) result->wall_absorbed[b] = fibrad_heat_absorbs(heat, own);
    }
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        if (heat->openings >> k & 1) result->surroundings_power += heat->solution.power[fibrad_heat_body(heat, k)];
        read_beyond(heat, k, result);
    }
    const bool inside =
        result->least_temperature != NULL || result->largest_temperature != NULL || result->surface_error != NULL;
    if (heat->contacts.count > 0) find_joined_errors(heat);
    if (heat->sources.conducts && heat->solution.steps && inside)
        fibrad_heat_find_extremes(heat, 0, spheres, heat->near);
    read_errors(heat, result);
    result->sweeps = heat->solution.sweeps;
    result->residual = heat->solution.scale > 0 ? fibrad_sqrt(heat->solution.slope / heat->solution.scale) : 0;
    return read_temperatures(heat, result) ? FIBRAD_OK : FIBRAD_E_UNSOLVABLE;
}

/* Sums over the patches of a side: areas, flows, areas times radiosities. */
typedef struct side_sum {
    double area, flow, radiosity;
} side_sum;

/* flow[patches]: net flows, or light that is absorbed. */
static side_sum sum_of_side(const fibrad_heat *heat, const fibrad_mesh_cut *cut, const double *flow) {
    const uint32_t begin = fibrad_heat_first_meshed(heat) + cut->patch;
    side_sum sum = {0, 0, 0};
    if (cut->patch == UINT32_MAX) return sum;
    for (uint32_t a = begin; a < begin + (UINT32_C(1) << cut->halvings); a++)
        sum.area += heat->solution.area[a], sum.flow += flow[a],
            sum.radiosity += heat->solution.area[a] * heat->solution.radiosity[a];
    return sum;
}

/* The area of those sides of a mesh whose patches are met, and their flow. */
typedef struct mesh_gain {
    double area, flow;
    bool whole; /* no plane or cylinder cuts the mesh; areas are then those of triangles, else those from beams */
} mesh_gain;

static bool is_within_walls(const fibrad_scene *scene, uint32_t triangle) {
    bool inside = true;
    double corner[3][3];
    fibrad_mesh_corners(&scene->mesh, triangle, corner);
    for (int k = 0; k < 3 && scene->container.walls; k++)
        inside = inside && fibrad_walls_hold(&scene->container, corner[k]);
    return inside;
}

static mesh_gain gain_of_mesh(const fibrad_heat *heat, uint32_t m, const double *flow) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
    mesh_gain gain = {0, 0, true};
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const side_sum sum = sum_of_side(heat, fibrad_mesh_cut_of(mesh, heat->cut, mesh->side[k]), flow);
        const double area = fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(mesh->side[k]));
        gain.whole = gain.whole && is_within_walls(heat->scene, fibrad_side_triangle(mesh->side[k]));
        if (sum.area > 0) gain.area += area, gain.flow += area * (sum.flow / sum.area);
    }
    if (!gain.whole) gain.area = gain.flow = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1] && !gain.whole; a++)
        gain.area += heat->solution.area[a], gain.flow += flow[a];
    return gain;
}

/* A power of a mesh per area minus the flow of its patches per area: from extrapolation, residuals, and areas by beams.
 */
static double flux_beyond_patches(const fibrad_heat *heat, uint32_t m, const double *flow, double power) {
    const mesh_gain gain = gain_of_mesh(heat, m, flow);
    return gain.area > 0 ? (power - gain.flow) / gain.area : 0;
}

/* The light that the sides of a mesh have absorbed, by patch. NULL: none, or they give it off again. */
static const double *light_of_mesh(const fibrad_heat *heat, uint32_t m) {
    return fibrad_heat_is_insulated(heat, fibrad_heat_body(heat, FIBRAD_MESHES + m)) ? NULL : heat->sources.absorbed;
}

/* The net power of a side per area. beyond: what patches lack of the powers of its mesh: of net powers, and of light.
 */
static double flux_of_side(const fibrad_heat *heat, uint32_t m, const fibrad_mesh_cut *cut, const double beyond[2]) {
    const side_sum net = sum_of_side(heat, cut, heat->solution.net);
    const double *light = light_of_mesh(heat, m);
    if (!(net.area > 0)) return __builtin_nan("");
    const bool emits = heat->sources.emissivity[fibrad_heat_body(heat, FIBRAD_MESHES + m)] > 0;
    return (emits ? net.flow / net.area + beyond[0] : 0) +
           (light != NULL ? sum_of_side(heat, cut, light).flow / net.area + beyond[1] : 0);
}

static double temperature_of_side(const fibrad_heat *heat, uint32_t b, const fibrad_mesh_cut *cut,
                                  const side_sum *sum) {
    if (fibrad_heat_is_insulated(heat, b))
        return sum->area > 0 ? fibrad_heat_temperature(heat, sum->radiosity / sum->area) : __builtin_nan("");
    const double *lift = fibrad_heat_lift(heat, b);
    if (lift == NULL) return heat->sources.temperature[b];
    const uint32_t a = fibrad_heat_first_meshed(heat) + cut->patch - heat->first[b];
    const double t = fibrad_heat_temperature(heat, heat->sources.emission[b] + lift[a]);
    return t >= 0 ? t : 0;
}

int fibrad_heat_read_sides(const fibrad_heat *heat, double *flux, double *temperature) {
    double beyond[FIBRAD_WALLS_MAX][2];
    if (heat == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase != FIBRAD_HEAT_DONE || !fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    const fibrad_mesh *mesh = &heat->scene->mesh;
    for (uint32_t m = 0; m < heat->meshes; m++) {
        const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
        const double *light = light_of_mesh(heat, m);
        beyond[m][0] = flux_beyond_patches(heat, m, heat->solution.net, heat->solution.power[b]);
        beyond[m][1] = light != NULL ? flux_beyond_patches(heat, m, light, fibrad_heat_absorbed(heat, b)) : 0;
    }
    for (uint32_t s = 0; s < 2 * heat->triangles; s++) {
        const fibrad_mesh_cut *cut = fibrad_mesh_cut_of(mesh, heat->cut, s);
        const size_t to = (size_t)(cut - heat->cut);
        double q = __builtin_nan(""), t = q;
        if (cut->patch != UINT32_MAX) {
            const uint32_t m = fibrad_side_mesh(mesh, s), b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
            const side_sum sum = sum_of_side(heat, cut, heat->solution.net);
            q = flux_of_side(heat, m, cut, beyond[m]);
            t = temperature_of_side(heat, b, cut, &sum);
        }
        if (flux != NULL) flux[to] = q;
        if (temperature != NULL) temperature[to] = t;
    }
    return FIBRAD_OK;
}
