/* heat_run.c - net powers of one bed in watts, and their summary. SPDX-License-Identifier: MIT */
#include "heat/heat_run.h"

#include <gsl/gsl_math.h>

#include "bed/bed_scene.h"
#include "cli/memory.h"
#include "cli/message.h"

static bool heat_insulates(const fibrad_heat_sources *sources, uint32_t walls) {
    bool any = false;
    for (uint32_t k = 0; k < walls; ++k) any |= sources->insulated && sources->insulated[k];
    return any;
}

/* The error of the power of the surroundings over the larger of two powers: that of the surroundings, and SMALL_SHARE
 * of all that is exchanged. */
#define SMALL_SHARE .05
static double heat_outside_error(const fibrad_heat_result *result, uint32_t spheres, uint32_t walls) {
    double sum = fabs(result->surroundings_power);
    for (uint32_t i = 0; i < spheres; ++i) sum += fabs(result->power[i]);
    for (uint32_t k = 0; k < walls; ++k) sum += fabs(result->wall_power[k]);
    const double error = result->surroundings_error;
    return error > 0 ? error / fmax(fabs(result->surroundings_power), SMALL_SHARE * sum / 2) : 0;
}

/* heat_report.wall_error. d(T^4)/T^4 = 4 dT/T. What insulated walls send back goes to the surroundings in the end, so
 * that the error of such walls is that of the surroundings, too. */
static double heat_wall_error(const fibrad_heat_result *result, const fibrad_heat_sources *sources, uint32_t spheres,
                              uint32_t walls) {
    double worst = heat_insulates(sources, walls) ? heat_outside_error(result, spheres, walls) : 0;
    for (uint32_t k = 0; k < walls; ++k) {
        if (result->wall_error[k] > 0)
            worst = fmax(worst, result->wall_error[k] / fmax(fabs(result->wall_power[k]), result->wall_absorbed[k]));
        if (result->wall_temperature_error[k] > 0)
            worst = fmax(worst, 4 * result->wall_temperature_error[k] / result->wall_temperature[k]);
    }
    return worst;
}

static void heat_summarise(const struct bed *bed, const fibrad_heat_sources *sources, uint32_t walls,
                           struct heat_report *report) {
    const fibrad_heat_result *result = &report->result;
    const double sphere = 4 * M_PI * FIBRAD_STEFAN_BOLTZMANN * report->metres * report->metres;
    double square = 0, squares = 0, throughput = 0;
    report->balance = result->surroundings_power;
    report->largest = fabs(result->surroundings_power);
    for (uint32_t k = 0; k < walls; ++k) {
        report->balance += result->wall_power[k];
        report->largest = fmax(report->largest, fabs(result->wall_power[k]));
    }
    report->emitted = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double power = result->power[i], radiation = power - (result->conducted ? result->conducted[i] : 0);
        const double emissivity = sources->emissivity[i];
        const double emitted =
            emissivity > 0 ? sphere * bed->r[i] * bed->r[i] * emissivity * pow(result->temperature[i], 4) : 0;
        const double through = fmax(emitted, emitted + radiation);
        report->emitted += emitted;
        report->balance += power;
        square += power * power;
        squares += through * through;
        throughput += through;
        report->largest = fmax(report->largest, fabs(power));
    }
    report->power_rms = sqrt(square / bed->n);
    report->throughput = sqrt(squares / bed->n);
    report->balance_of_emission = throughput > 0 ? report->balance / throughput : 0;
    report->error = hypot(result->error_patches, result->error_beams);
    report->wall_error = heat_wall_error(result, sources, bed->n, walls);
}

/* Figures of the spheres whose temperatures were found. */
static void heat_temperatures(const struct bed *bed, const fibrad_heat_sources *sources, struct heat_report *report) {
    const fibrad_heat_result *result = &report->result;
    double sum = 0, square = 0, errors = 0, emissions = 0;
    report->unknown = 0;
    report->coldest = INFINITY, report->hottest = -INFINITY;
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (!isnan(sources->temperature[i]) || isnan(result->temperature[i])) continue;
        report->unknown++;
        const double t = result->temperature[i], error = result->temperature_error[i];
        sum += t, square += error * error;
        errors += gsl_pow_2(4 * gsl_pow_3(t) * error), emissions += gsl_pow_8(t);
        report->coldest = fmin(report->coldest, result->temperature[i]);
        report->hottest = fmax(report->hottest, result->temperature[i]);
    }
    report->temperature_mean = sum / report->unknown;
    report->temperature_error = sqrt(square / report->unknown);
    report->emission_error = emissions > 0 ? sqrt(errors / emissions) : 0;
}

/* Figures of surfaces and centres of spheres that conduct. */
static void heat_surfaces(const struct bed *bed, struct heat_report *report) {
    const fibrad_heat_result *result = &report->result;
    double square = 0;
    uint32_t n = 0;
    report->surface_min = INFINITY, report->surface_max = report->centre_max = -INFINITY, report->surface_span = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double low = result->least_temperature[i], high = result->largest_temperature[i];
        if (isnan(low)) continue;
        report->surface_min = fmin(report->surface_min, low), report->surface_max = fmax(report->surface_max, high);
        report->surface_span = fmax(report->surface_span, high - low);
        report->centre_max = fmax(report->centre_max, result->centre_temperature[i]);
        square += gsl_pow_2(result->surface_error[i]), ++n;
    }
    report->surface_error = n > 0 ? sqrt(square / n) : 0;
}

/* Says why no temperatures have the given powers if none is given at all. sum: of the powers [W]. magnitude: of their
 * magnitudes. */
static int heat_no_level(const char *file, double sum, double magnitude) {
    if (fabs(sum) <= 1e-12 * magnitude)
        return message_at(STATUS_INPUT, file, 0, "no temperature is given in this closed bed; give one, or --ambient");
    return message_at(STATUS_INPUT, file, 0,
                      "no temperature is given in this closed bed, and its powers add up to %g W, not to 0", sum);
}

/* Says why no temperatures have the given powers. */
static int heat_unsolvable(const struct bed_options *options, const struct heat_problem *problem, const struct bed *bed,
                           const struct heat_report *report) {
    const fibrad_heat_sources *sources = &problem->sources;
    const double square_metres = report->metres * report->metres;
    const uint32_t walls = problem->walls.count;
    bool given = !isnan(sources->surroundings);
    double sum = 0, magnitude = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        given |= !isnan(sources->temperature[i]);
        if (!isnan(sources->temperature[i])) continue;
        sum += sources->power[i] * square_metres;
        magnitude += fabs(sources->power[i]) * square_metres;
    }
    for (uint32_t k = 0; k < walls; ++k) {
        given |= !isnan(sources->wall_temperature[k]);
        if (!isnan(sources->wall_temperature[k]) || sources->insulated[k]) continue;
        sum += sources->wall_power[k] * square_metres;
        magnitude += fabs(sources->wall_power[k]) * square_metres;
    }
    if (!given) return heat_no_level(options->name, sum, magnitude);
    for (uint32_t i = 0; i < bed->n; ++i)
        if (isnan(sources->temperature[i]) && isnan(report->result.temperature[i]) &&
            (sources->emissivity[i] > 0 || sources->power[i] != 0))
            return message_at(STATUS_INPUT, options->name, bed->line[i],
                              "sphere %lld: no temperature above 0 K gives off %g W here", (long long)bed_name(bed, i),
                              sources->power[i] * square_metres);
    for (uint32_t k = 0; k < walls; ++k)
        if (isnan(sources->wall_temperature[k]) && !sources->insulated[k] && isnan(report->result.wall_temperature[k]))
            return message_at(STATUS_INPUT, options->name, 0, "wall %s: no temperature above 0 K gives off %g W here",
                              wall_name(&problem->walls, k), sources->wall_power[k] * square_metres);
    return heat_no_level(options->name, sum, magnitude);
}

/* Powers of the library are per area in the bed's unit of length. In watts they are square_metres times as large. */
static void heat_scale(const struct bed *bed, uint32_t walls, double square_metres, fibrad_heat_result *result) {
    if (square_metres == 1) return;
    for (uint32_t i = 0; i < bed->n; ++i) result->power[i] *= square_metres, result->power_error[i] *= square_metres;
    for (uint32_t k = 0; k < walls; ++k) {
        result->wall_power[k] *= square_metres;
        result->wall_error[k] *= square_metres;
        result->wall_absorbed[k] *= square_metres;
        result->wall_area[k] *= square_metres;
    }
    result->surroundings_power *= square_metres, result->surroundings_error *= square_metres;
    result->error_patches *= square_metres;
    result->error_beams *= square_metres;
}

/* Default numbers of directions. _BEGIN: with --error. _BRIGHT: if the mean emissivity is at most BRIGHT and there are
 * at most PATCHES_BRIGHT patches. Patches then err more than so few directions do. With still fewer directions all
 * beams would be kept instead of half of them. _DARK: otherwise. Source: docs/heat.md, Settings. */
enum {
    DIRECTIONS_BEGIN = 72,
    DIRECTIONS_DARK = FIBRAD_HEAT_DIRECTIONS_DEFAULT,
    DIRECTIONS_BRIGHT = 112,
    PATCHES_BRIGHT = FIBRAD_HEAT_PATCHES_DEFAULT
};
#define BRIGHT 0.35
#define POINTS 64

/* Least number of rays between walls if a wall is insulated, for each patch of a sphere. Patches of insulated walls
 * need more rays than other ones: docs/methods_heat.md section 7. */
#define RAYS_INSULATED (2 * FIBRAD_WALL_RAYS_DEFAULT / FIBRAD_HEAT_PATCHES_DEFAULT)

/* problem->config with defaults filled in. The number of directions follows from the emissivities of the bed. With
 * problem->error it is the number to begin with. */
static fibrad_heat_config heat_config(const struct heat_problem *problem, const struct bed *bed) {
    fibrad_heat_config config = problem->config;
    double areas = 0, sum = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        areas += bed->r[i] * bed->r[i];
        sum += bed->r[i] * bed->r[i] * problem->emissivity[i];
    }
    const bool bright = sum <= BRIGHT * areas && config.patches <= PATCHES_BRIGHT;
    if (!config.directions)
        config.directions = problem->error > 0 ? DIRECTIONS_BEGIN : bright ? DIRECTIONS_BRIGHT : DIRECTIONS_DARK;
    if (!config.points) config.points = POINTS;
    if (!config.wall_rays && heat_insulates(&problem->sources, problem->walls.count))
        config.wall_rays = RAYS_INSULATED * (config.patches ? config.patches : FIBRAD_HEAT_PATCHES_DEFAULT);
    return config;
}

/* Refuses a problem that will not fit into memory. Source: fibrad_heat_size. */
static int heat_memory(const struct bed *bed, const fibrad_heat_config *config) {
    const double beams = (double)config->directions * config->points, patches = config->patches;
    const double kept = fmin(beams, 4 * sqrt(beams / 2 * patches)), number = patches > 96 ? 2 : 1;
    const double others = 4000; /* bytes for the spheres that one sphere sees */
    return memory_check(bed->n * (3 * number * kept + 8 * 7 * patches + others),
                        "fewer --directions, --points or --patches take less");
}

void heat_properties(const struct heat_problem *problem, const struct bed *bed, const double *temperature,
                     double *emissivity) {
    quantity_follow(problem->of_emissivity, bed, temperature, emissivity);
    if (!problem->solid) return;
    quantity_follow(problem->of_solid, bed, temperature, problem->solid);
    for (uint32_t i = 0; i < bed->n; ++i) problem->conductivity[i] = problem->solid[i] * problem->per_watt;
}

void heat_excess_of(const struct heat_problem *problem, const struct bed *bed, const double *temperature,
                    const double *wall_temperature, struct table_excess excess[TABLES]) {
    quantity_excess(problem->of_emissivity, bed, temperature, &excess[0]);
    quantity_excess(problem->of_solid, bed, temperature, &excess[1]);
    contacts_excess(problem->contacts, bed, temperature, wall_temperature, &excess[2]);
}

void heat_warn_excess(struct warned *warned, const struct table_excess excess[TABLES]) {
    warn_table(warned, "--emissivity", &excess[0]);
    warn_table(warned, "--solid-conductivity", &excess[1]);
    contacts_warn(warned, &excess[2]);
}

/* Context of heat_follow. */
struct heat_law {
    const struct heat_problem *problem;
    const struct bed *bed;
};

static void heat_follow(void *law, const double *temperature, const double *wall_temperature, double *emissivity,
                        double *wall_emissivity) {
    const struct heat_law *how = law;
    (void)wall_emissivity;
    heat_properties(how->problem, how->bed, temperature, emissivity);
    contacts_follow(how->problem->contacts, how->bed, temperature, wall_temperature);
}

/* Tolerance of the radiosities over problem->error: so small that it adds nothing to the error. */
#define SOLVED 5e-3

/* Solves the problem. Status as of heat_run, or FIBRAD_E_UNSUPPORTED if the report has a solution already and the
 * configuration is too fine for this bed. The solution then stays. */
static int heat_once(struct bed_options *options, const struct heat_problem *problem, const struct bed *bed,
                     struct heat_report *report) {
    const double begun = progress_clock();
    const fibrad_scene_config scene = bed_scene(bed, &problem->walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_heat_sources sources = problem->sources;
    fibrad_run run = bed_options_run(options);
    fibrad_radiation *radiation;
    double wall_emissivity[WALLS_MAX];
    for (uint32_t k = 0; k < problem->walls.count; ++k) wall_emissivity[k] = sources.wall_emissivity[k];
    if (problem->error > 0) sources.tolerance = fmin(1e-5, SOLVED * problem->error);
    if (isnan(sources.surroundings)) sources.surroundings = 0; /* closed bed: no radiation reaches the surroundings */
    int status = heat_memory(bed, &report->config);
    if (status) return status;
    status = fibrad_radiation_new(&radiation, &scene, &spheres, &report->config, &run);
    if (status == FIBRAD_E_UNSUPPORTED && report->seconds > 0) return status;
    if (!status)
        status = light_absorb(problem->light, &(struct lit_bed){bed, &problem->walls, radiation, NULL, 1}, &sources);
    if (!status)
        status = fibrad_radiation_settle(radiation, &sources, heat_follow, &(struct heat_law){problem, bed},
                                         problem->emissivity, wall_emissivity, &report->result);
    if (!status && report->triangles.count) {
        status = fibrad_radiation_sides(radiation, report->triangles.quantity[TRIANGLE_FLUX].side,
                                        report->triangles.quantity[TRIANGLE_TEMPERATURE].side);
        triangle_heat_show(&report->triangles, 1);
    }
    sources.emissivity = problem->emissivity, sources.wall_emissivity = wall_emissivity;
    if (!status) status = face_solve(problem->face, bed, &problem->walls, &sources, &run);
    fibrad_radiation_describe(radiation, &report->facts, &run.fault);
    fibrad_radiation_free(radiation);
    if (status) progress_stop(&options->progress);
    if (light_refuse(problem->light, bed, status, &run.fault)) return STATUS_USAGE;
    const int refused = contacts_refuse(problem->contacts, options, bed, &problem->walls, status, &run.fault);
    if (refused) return refused;
    if (status == FIBRAD_E_UNSOLVABLE) {
        progress_stop(&options->progress);
        return heat_unsolvable(options, problem, bed, report);
    }
    status = bed_options_status(options, bed, status, &run.fault);
    if (status) return status;
    heat_temperatures(bed, &sources, report);
    light_add(problem->light, &sources, bed->n, problem->walls.count, &report->result);
    if (problem->solid) {
        heat_surfaces(bed, report);
        warn_surfaces(&options->warned, bed, report->result.least_temperature);
    }
    heat_scale(bed, problem->walls.count, report->metres * report->metres, &report->result);
    contacts_scale(problem->contacts, bed->n, problem->walls.count);
    light_scale(problem->light, bed->n, problem->walls.count, report->metres * report->metres);
    heat_summarise(bed, &sources, problem->walls.count, report);
    report->seconds = progress_clock() - begun;
    return STATUS_OK;
}

/* Largest number of rays between walls. */
#define WALL_RAYS_MOST (1u << 23)

/* Estimated errors over those that --error allows. */
struct heat_excess {
    double beams, patches; /* of the powers of spheres: the part due to beams and the part due to patches */
    double walls;          /* heat_report.wall_error */
    double emission;       /* heat_report.emission_error */
};

/* The error of powers is relative to their root mean square, but at least to 1e-3 of what spheres emit: powers that
 * nearly cancel need not be known to problem->error of themselves. */
static struct heat_excess heat_compare(const struct heat_problem *problem, const struct heat_report *report) {
    const double allowed = problem->error * fmax(report->power_rms, 1e-3 * report->throughput);
    const fibrad_heat_result *result = &report->result;
    return (struct heat_excess){.beams = allowed > 0 ? result->error_beams / allowed : 0,
                                .patches = allowed > 0 ? result->error_patches / allowed : 0,
                                .walls = report->wall_error / problem->error,
                                .emission = report->emission_error / problem->error};
}

static double heat_worst(const struct heat_excess *over) {
    return fmax(hypot(over->beams, over->patches), fmax(over->walls, over->emission));
}

#define HELPED       0.6  /* a change helps if at most this part of the error is left */
#define PATCHES_MOST 0.92 /* most of the allowed error that patches may have; else beams would have to be exact */
enum { GROWTH = 8 };

/* Multiplies the number of directions, by 1.5 to `most`, up to the largest number there may be. */
static void heat_more_beams(fibrad_heat_config *config, double times, double most) {
    config->directions = (uint32_t)fmin(config->directions * fmin(fmax(times, 1.5), most), FIBRAD_DIRECTIONS_MAX);
}

/* Four times the patches need four times the beams, so that each patch keeps its number of beams. */
static void heat_more_patches(fibrad_heat_config *config) {
    config->patches *= 4;
    heat_more_beams(config, 4, GROWTH);
}

/* Rays between walls: the error falls as the square root of their number. */
static void heat_more_rays(fibrad_heat_config *config, double over, double most) {
    const uint32_t rays = config->wall_rays > 0 ? config->wall_rays : FIBRAD_WALL_RAYS_DEFAULT;
    config->wall_rays = (uint32_t)fmin(rays * fmin(fmax(over * over, 2), most), WALL_RAYS_MOST);
}

/* The next configuration. If the powers of spheres err too much, it has more of what errs more, patches or beams. It
 * stays as it is if more patches are impossible and beams err little. If temperatures err too much, it has more beams,
 * or more patches where beams have not helped. If walls err too much, it has more rays between walls as long as those
 * help, then more beams. Errors are about inverse to the number of beams. most: by which beams and rays may grow. */
static fibrad_heat_config heat_refine(fibrad_heat_config config, const struct heat_excess *over,
                                      const struct heat_excess *last, double most) {
    const bool finer = config.patches < FIBRAD_HEAT_PATCHES_MAX;
    const double beams_allowed = sqrt(1 - pow(fmin(over->patches, PATCHES_MOST), 2));
    if (over->walls > 1 && over->walls <= HELPED * last->walls) heat_more_rays(&config, over->walls, most);
    if (hypot(over->beams, over->patches) > 1) {
        if (over->patches > PATCHES_MOST && finer)
            heat_more_patches(&config);
        else if (over->beams > beams_allowed)
            heat_more_beams(&config, over->beams / beams_allowed, most);
    } else if (over->emission > 1) {
        if (over->emission > HELPED * last->emission && finer)
            heat_more_patches(&config);
        else
            heat_more_beams(&config, over->emission, most);
    } else if (over->walls > HELPED * last->walls) {
        heat_more_beams(&config, over->walls, most);
    }
    return config;
}

/* Estimated time of beams and rays, in units of one beam of a sphere. One ray of a wall takes as long as BEAMS_A_RAY
 * beams. */
#define BEAMS_A_RAY 12.0
static double heat_rays_work(uint32_t walls, const fibrad_heat_config *config) {
    const double beams = (double)config->directions * config->points;
    const double rays = fmax(fmax(config->wall_rays, FIBRAD_WALL_RAYS_DEFAULT), 6 * beams);
    return walls > 0 ? BEAMS_A_RAY * rays : 0;
}
static double heat_work(const struct bed *bed, uint32_t walls, const fibrad_heat_config *config) {
    return bed->n * ((double)config->directions * config->points) + heat_rays_work(walls, config);
}

/* A warning is printed beforehand if --error takes more than COSTLY times as long as the defaults, or once more if it
 * takes TOO_SHORT times as long as a warning has said. */
#define COSTLY    20
#define TOO_SHORT 1.3

/* When a run has begun, and how long it takes by the last warning [s]. */
struct heat_times {
    double begun, said;
};

/* Warns if a run will take long. over, last: errors of this round and of the one before. */
static void heat_foresee(const struct bed_options *options, const struct heat_problem *problem, const struct bed *bed,
                         const struct heat_report *report, const struct heat_excess *over,
                         const struct heat_excess *last, struct heat_times *times) {
    const struct heat_problem plain = {.config = problem->config, .emissivity = problem->emissivity};
    const uint32_t walls = problem->walls.count;
    const fibrad_heat_config defaults = heat_config(&plain, bed);
    const fibrad_heat_config next = heat_refine(report->config, over, last, GROWTH);
    const fibrad_heat_config end = heat_refine(report->config, over, last, INFINITY);
    const double unit = report->seconds / heat_work(bed, walls, &report->config);
    const double usual = unit * heat_work(bed, walls, &defaults), work = heat_work(bed, walls, &end);
    const bool rounds = end.directions > next.directions || end.wall_rays > next.wall_rays;
    const double seconds =
        progress_clock() - times->begun + unit * (work + (rounds ? heat_work(bed, walls, &next) : 0));
    if (!(seconds > fmax(COSTLY * usual, TOO_SHORT * times->said))) return;
    message_at(STATUS_OK, options->name, 0,
               "warning: --error %g takes about %.0f s, %.0f times as long as without --error%s", problem->error,
               ceil(seconds), seconds / usual,
               2 * heat_rays_work(walls, &end) > work ? "; most of it is for rays between walls" : "");
    times->said = seconds;
}

/* Solves again with finer configurations until the errors are small enough or the configuration cannot be finer. */
static int heat_improve(struct bed_options *options, const struct heat_problem *problem, const struct bed *bed,
                        struct heat_report *report) {
    struct heat_times times = {progress_clock() - report->seconds, 0};
    struct heat_excess last = {INFINITY, INFINITY, INFINITY, INFINITY}, over = heat_compare(problem, report);
    while (heat_worst(&over) > 1) {
        const fibrad_heat_config next = heat_refine(report->config, &over, &last, GROWTH);
        if (next.directions == report->config.directions && next.patches == report->config.patches &&
            next.wall_rays == report->config.wall_rays)
            break;
        heat_foresee(options, problem, bed, report, &over, &last, &times);
        const fibrad_heat_config before = report->config;
        report->config = next;
        const int status = heat_once(options, problem, bed, report);
        if (status == FIBRAD_E_UNSUPPORTED) {
            report->config = before;
            break;
        }
        if (status) return status;
        last = over;
        over = heat_compare(problem, report);
    }
    report->error_reached = problem->error * heat_worst(&over);
    return STATUS_OK;
}

int heat_run(struct bed_options *options, const struct heat_problem *problem, const struct bed *bed,
             struct heat_report *report) {
    const double begun = progress_clock();
    report->config = heat_config(problem, bed);
    int status = heat_once(options, problem, bed, report);
    if (!status && problem->error > 0) status = heat_improve(options, problem, bed, report);
    report->seconds = progress_clock() - begun;
    struct table_excess excess[TABLES] = {{0}};
    if (!status) heat_excess_of(problem, bed, report->result.temperature, report->result.wall_temperature, excess);
    heat_warn_excess(&options->warned, excess);
    return status;
}
