/* heat_error.c - how fine a heat problem is solved: by default, and for --error. SPDX-License-Identifier: MIT */
#include <math.h>

#include "heat/heat.h"

/* Default numbers of directions. _BEGIN: the least with --error. _BRIGHT: if the mean emissivity is at most BRIGHT and
 * there are at most PATCHES_BRIGHT patches. Patches then err more than so few directions do. With still fewer
 * directions all beams would be kept instead of half of them. _DARK: otherwise. Source: docs/heat.md, Settings. */
enum {
    DIRECTIONS_BEGIN = 72,
    DIRECTIONS_DARK = FIBRAD_HEAT_DIRECTIONS_DEFAULT,
    DIRECTIONS_BRIGHT = 112,
    PATCHES_BRIGHT = FIBRAD_HEAT_PATCHES_DEFAULT
};
#define BRIGHT 0.35

/* The number of directions to begin with for --error E. Most beds need 0.8/E to 1.25/E, so most need one round. From
 * ERROR_SMALL down, DIRECTIONS_BEGIN tell what is needed: they are then a small part of it. */
#define ERROR_SMALL .006
static uint32_t directions_to_begin(double error) {
    return error < ERROR_SMALL ? DIRECTIONS_BEGIN : (uint32_t)fmax(DIRECTIONS_BEGIN, 1.25 / error);
}
#define POINTS 64

/* Least number of rays between walls if a wall is insulated, for each patch of a sphere. Patches of insulated walls
 * need more rays than other ones: docs/methods.md section 19. */
#define RAYS_INSULATED (2 * FIBRAD_WALL_RAYS_DEFAULT / FIBRAD_HEAT_PATCHES_DEFAULT)

/* The configuration of the options with defaults filled in. The number of directions follows from the emissivities of
 * the bed. refined: it is the number to begin with for --error. insulated: a wall is. */
static fibrad_heat_config fill_config(const struct heat *h, bool refined, bool insulated) {
    fibrad_heat_config config = h->config;
    const double *r = h->bed->r;
    double areas = 0, sum = 0;
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        areas += r[i] * r[i];
        sum += r[i] * r[i] * h->emissivity[i];
    }
    const bool spots = h->conductivity && h->touching.n > 0; /* flows need them, and know no number for an error */
    const bool bright = sum <= BRIGHT * areas && config.patches <= PATCHES_BRIGHT;
    if (!config.directions)
        config.directions = refined && !spots ? directions_to_begin(h->error)
                            : bright          ? DIRECTIONS_BRIGHT
                                              : DIRECTIONS_DARK;
    if (!config.points) config.points = POINTS;
    if (!config.wall_rays && insulated)
        config.wall_rays = RAYS_INSULATED * (config.patches ? config.patches : FIBRAD_HEAT_PATCHES_DEFAULT);
    return config;
}

/* Largest number of rays between walls. */
#define WALL_RAYS_MOST (1u << 23)

/* Estimated errors over those that --error allows. */
struct excess {
    double beams, patches; /* of the powers of spheres: the part due to beams and the part due to patches */
    double walls;          /* heat_figures.wall_error */
    double emission;       /* heat_figures.emission_error */
    double flows;          /* heat_figures.flow_error */
};

/* The error of powers is relative to their root mean square, but at least to 1e-3 of what spheres emit: powers that
 * nearly cancel need not be known to heat->error of themselves. */
static struct excess compare_errors(const struct heat *h) {
    const struct heat_figures *f = &h->figures;
    const double allowed = h->error * fmax(f->power_rms, 1e-3 * f->throughput);
    return (struct excess){.beams = allowed > 0 ? h->result.error_beams / allowed : 0,
                           .patches = allowed > 0 ? h->result.error_patches / allowed : 0,
                           .walls = f->wall_error / h->error,
                           .emission = f->emission_error / h->error,
                           .flows = f->flow_error / h->error};
}

static double worst_of(const struct excess *over) {
    return fmax(fmax(hypot(over->beams, over->patches), over->flows), fmax(over->walls, over->emission));
}

/* What directions do for flows through contacts: at most as much as this many times as many. */
#define BEAMS_FOR_FLOWS 2.0

#define HELPED       0.6  /* a change helps if at most this part of the error is left */
#define PATCHES_MOST 0.92 /* most of the allowed error that patches may have; else beams would have to be exact */
enum { GROWTH = 8 };

/* Multiplies the number of directions, by 1.5 to `most`, up to the largest number there may be. The estimates scatter,
 * so it takes some more than they say: a further round costs more. */
#define SPARE 1.1
static void add_beams(fibrad_heat_config *config, double times, double most) {
    const double wanted = fmin(fmax(SPARE * times, 1.5), most);
    config->directions = (uint32_t)fmin(config->directions * wanted, FIBRAD_DIRECTIONS_MAX);
}

/* The part of the error of patches that is left of four times the patches. */
#define PATCHES_LEFT 0.5

/* The part of the allowed error that beams may have beside patches. */
static double beams_beside(double patches) { return sqrt(1 - pow(fmin(patches, PATCHES_MOST), 2)); }

/* Four times the patches need four times the beams, so that each patch keeps its number of beams, and more if beams
 * err too much as well. */
static void add_patches(fibrad_heat_config *config, const struct excess *over) {
    config->patches *= 4;
    add_beams(config, fmax(4, over->beams / beams_beside(PATCHES_LEFT * over->patches)), GROWTH);
}

/* The number of rays between walls: with more beams at least as many as the kernel's default. */
static double rays_of(const fibrad_heat_config *config) {
    const double beams = (double)config->directions * config->points;
    return fmax(fmax(config->wall_rays, FIBRAD_WALL_RAYS_DEFAULT), 6 * beams);
}

/* Rays between walls: the error falls as the square root of their number. */
static void add_wall_rays(fibrad_heat_config *config, double over, double most) {
    const uint32_t rays = config->wall_rays > 0 ? config->wall_rays : FIBRAD_WALL_RAYS_DEFAULT;
    config->wall_rays = (uint32_t)fmin(rays * fmin(fmax(over * over, 2), most), WALL_RAYS_MOST);
}

/* The next configuration. If the powers of spheres err too much, it has more of what errs more, patches or beams. It
 * stays as it is if more patches are impossible and beams err little. If temperatures err too much, it has more beams,
 * or more patches where beams have not helped. If walls err too much, it has more rays between walls as long as those
 * help, then more beams. Errors are about inverse to the number of beams. most: by which beams and rays may grow. */
static fibrad_heat_config refine(fibrad_heat_config config, const struct excess *over, const struct excess *last,
                                 double most) {
    const bool finer = config.patches < FIBRAD_HEAT_PATCHES_MAX;
    const double beams_allowed = beams_beside(over->patches);
    if (over->walls > 1 && over->walls <= HELPED * last->walls) add_wall_rays(&config, over->walls, most);
    if (hypot(over->beams, over->patches) > 1) {
        if (over->patches > PATCHES_MOST && finer)
            add_patches(&config, over);
        else if (over->beams > beams_allowed)
            add_beams(&config, over->beams / beams_allowed, most);
    } else if (over->emission > 1) {
        if (over->emission > HELPED * last->emission && finer)
            add_patches(&config, over);
        else
            add_beams(&config, over->emission, most);
    } else if (over->walls > fmax(1, HELPED * last->walls)) {
        add_beams(&config, over->walls, most);
    } else if (over->flows > 1 && over->flows <= HELPED * last->flows) {
        add_beams(&config, fmin(over->flows, BEAMS_FOR_FLOWS), most);
    }
    if (config.wall_rays > 0) config.wall_rays = (uint32_t)fmin(rays_of(&config), FIBRAD_WALL_RAYS_MAX);
    return config;
}

/* Estimated time of beams and rays, in units of one beam of a sphere. One ray of a wall takes as long as BEAMS_A_RAY
 * beams. */
#define BEAMS_A_RAY 12.0
static double work_of_rays(uint32_t walls, const fibrad_heat_config *config) {
    return walls > 0 ? BEAMS_A_RAY * rays_of(config) : 0;
}
static double work_of(const struct heat *h, const fibrad_heat_config *config) {
    return h->bed->n * ((double)config->directions * config->points) + work_of_rays(h->walls.count, config);
}

/* A warning is printed beforehand if --error takes more than COSTLY times as long as the defaults, or once more if it
 * takes TOO_SHORT times as long as a warning has said. */
#define COSTLY    20
#define TOO_SHORT 1.3

/* Rounds of --error. */
struct rounds {
    struct excess over, last; /* of this round and of the one before */
    double begun, said;       /* when the run has begun, and how long it takes by the last warning [s] */
};

/* Warns if a run will take long. */
static void foresee(const struct heat *h, struct rounds *rounds) {
    const struct excess *over = &rounds->over, *last = &rounds->last;
    const fibrad_heat_config defaults = fill_config(h, false, false);
    const fibrad_heat_config next = refine(h->used, over, last, GROWTH), end = refine(h->used, over, last, INFINITY);
    const double unit = h->seconds / work_of(h, &h->used), usual = unit * work_of(h, &defaults);
    const bool more = end.directions > next.directions || end.wall_rays > next.wall_rays;
    const double work = work_of(h, &end);
    const double seconds = progress_clock() - rounds->begun + unit * (work + (more ? work_of(h, &next) : 0));
    if (!(seconds > fmax(COSTLY * usual, TOO_SHORT * rounds->said))) return;
    message_at(STATUS_OK, h->options.name, 0,
               "warning: --error %g takes about %.0f s, %.0f times as long as without --error%s", h->error,
               ceil(seconds), seconds / usual,
               2 * work_of_rays(h->walls.count, &end) > work ? "; most of it is for rays between walls" : "");
    rounds->said = seconds;
}

/* Solves again with finer configurations until the errors are small enough or the configuration cannot be finer. */
static int improve(struct heat *h) {
    struct rounds rounds = {
        compare_errors(h), {INFINITY, INFINITY, INFINITY, INFINITY, INFINITY}, progress_clock() - h->seconds, 0};
    while (worst_of(&rounds.over) > 1) {
        const fibrad_heat_config before = h->used, next = refine(before, &rounds.over, &rounds.last, GROWTH);
        if (next.directions == before.directions && next.patches == before.patches &&
            next.wall_rays == before.wall_rays)
            break;
        foresee(h, &rounds);
        h->used = next;
        const int status = heat_solve(h);
        if (status == FIBRAD_E_UNSUPPORTED) {
            h->used = before;
            break;
        }
        if (status) return status;
        rounds.last = rounds.over;
        rounds.over = compare_errors(h);
    }
    h->error_reached = h->error * worst_of(&rounds.over);
    return STATUS_OK;
}

int heat_run(struct heat *h) {
    const double begun = progress_clock();
    struct table_excess excess[TABLES] = {{0}};
    h->used = fill_config(h, h->error > 0, heat_insulates(h));
    int status = heat_solve(h);
    if (!status && h->error > 0) status = improve(h);
    if (!status) status = face_solve(h);
    h->seconds = progress_clock() - begun;
    if (!status) heat_excess_of(h, h->result.temperature, h->result.wall_temperature, excess);
    heat_warn_excess(h, excess);
    return status;
}
