/* heat_time.c - temperatures of one bed in time. SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "heat/time_run.h"
#include "text/read_number.h"

enum { TIMES_MAX = 10000 };

#define CAPACITY_LEAST 1e-12 /* [J/(kg K)] */

int capacity_option(const char *text, void *of_spheres) {
    static const struct curve_axes axes = {CURVE_AXIS_KELVINS, {"c cp c_p capacity", "J/(kg K)"}};
    struct quantity *capacity = of_spheres;
    const bool held = strcmp(text, "inf") == 0;
    const int status = table_option("--heat-capacity", held ? "1" : text, &axes, CAPACITY_LEAST, INFINITY, capacity);
    if (held) capacity->value = INFINITY;
    return status;
}

int melting_option(const char *text, void *time_options) {
    struct time_options *time = time_options;
    double value[3] = {0};
    int n = 0, status = options_numbers("--melting", text, 3, value, &n);
    if (!status && n < 2) return message(STATUS_USAGE, "--melting: '%.60s' is not T,L or T,L,WIDTH", text);
    if (!status && !(value[1] > 0))
        return message(STATUS_USAGE, "--melting: the latent heat, %g J/kg, is not above 0", value[1]);
    if (!status && !(value[2] >= 0)) return message(STATUS_USAGE, "--melting: the width, %g K, is below 0", value[2]);
    time->melting = value[0], time->latent = value[1], time->width = value[2];
    return status;
}

int density_option(const char *text, void *density) { return quantity_option("--density", text, 1e-12, 1e12, density); }

int step_option(const char *text, void *step) {
    *(double *)step = 0;
    return strcmp(text, "auto") == 0 ? STATUS_OK : options_number("--step", text, 1 / SECONDS_MAX, SECONDS_MAX, step);
}

static bool is_every(const char *times) { return strncmp(times, "every:", 6) == 0; }

int every_option(const char *text, void *every) {
    if (!is_every(text))
        return message(STATUS_USAGE, "--times: '%.40s' is not every:S, the seconds from one output to the next", text);
    return options_number("--times every", text + 6, 1 / SECONDS_MAX, SECONDS_MAX, every);
}

int time_check(struct time_options *time, double zero, struct bed_options *bed) {
    const struct quantity *c = &time->capacity, *rho = &time->density;
    if (!(time->until > 0)) {
        const char *needs = c->given           ? "--heat-capacity"
                            : rho->given       ? "--density"
                            : time->times      ? "--times"
                            : time->step > 0   ? "--step"
                            : time->latent > 0 ? "--melting"
                                               : NULL;
        return needs ? message(STATUS_USAGE, "%s needs --until", needs) : STATUS_OK;
    }
    if (!c->given) return message(STATUS_USAGE, "--until needs --heat-capacity");
    if (time->latent > 0 && !(time->melting + zero - time->width / 2 > 0))
        return message(STATUS_USAGE, "--melting: %g less half of the width is not above absolute zero", time->melting);
    if (!rho->given) return message(STATUS_USAGE, "--until needs --density");
    if (time->times && is_every(time->times)) {
        const int status = every_option(time->times, &time->every);
        if (status) return status;
        if (time->until / time->every > TIMES_MAX)
            return message(STATUS_USAGE, "--times: more than %d times", TIMES_MAX);
        time->times = NULL;
    }
    time->capacity.some = true; /* infinite capacities may be in a column */
    bed_options_quantity(bed, &time->capacity, "J/(kg K)");
    time->capacity.some = false;
    bed_options_quantity(bed, &time->density, "kg/m3");
    return STATUS_OK;
}

static struct time_point point_of(const struct time_run *m, double time, const double *temperature) {
    struct time_point point = {time, 0, INFINITY, -INFINITY, time > 0 ? stream_outlet(m->heat) : NAN};
    for (uint32_t i = 0; i < m->bed.n; ++i) {
        point.mean += temperature[i] / m->bed.n;
        point.least = fmin(point.least, temperature[i]), point.most = fmax(point.most, temperature[i]);
    }
    return point;
}

static void note_point(void *time_run, double time, const double *temperature) {
    struct time_run *m = time_run;
    bool good = true;
    m->point = memory_grown(m->point, m->points, sizeof *m->point, &good);
    m->failed = m->failed || !good;
    if (good) m->point[m->points++] = point_of(m, m->now + time, temperature);
}

/* The temperature of a table at a time [K]. Without a table: `otherwise`. */
static double temperature_at(const struct time_run *m, const struct curve *curve, double time, double otherwise) {
    return curve->n > 0 ? curve_at(curve, time) + m->heat->given.zero : otherwise;
}

/* Temperatures of walls and surroundings at a time [K]. A closed bed has none for the surroundings (NaN). They get 0,
 * since no radiation reaches them. */
static void outside_at(const struct time_run *m, double time, double wall[WALLS_MAX], double *surroundings) {
    const struct heat *h = m->heat;
    const double around = h->given.surroundings;
    for (uint32_t k = 0; k < h->walls.count; ++k)
        wall[k] = temperature_at(m, &h->values.curve[k], time, h->sources.wall_temperature[k]);
    *surroundings = temperature_at(m, &h->given.ambient_curve, time, isnan(around) ? 0 : around);
}

/* The end of a span. Times of tables are such ends, since temperatures are linear between them. */
struct span_end {
    double time;
    bool output; /* a time of output */
};

/* Finds the ends of all spans in ascending order. */
static int find_times(const struct heat *h, struct span_end **ends, size_t *count) {
    const struct time_options *o = &h->time;
    const size_t every = o->every > 0 ? (size_t)ceil(o->until / o->every * (1 - 1e-12)) : 0;
    size_t room = every + TIMES_MAX + 2, n = 0;
    double listed[TIMES_MAX];
    int given = 0, status = o->times ? options_numbers("--times", o->times, TIMES_MAX, listed, &given) : STATUS_OK;
    if (status) return status;
    for (uint32_t k = 0; k < h->walls.count; ++k) room += h->values.curve[k].n;
    room += h->given.ambient_curve.n + h->film.gas_curve.n;
    struct span_end *end = *ends = malloc(room * sizeof *end);
    if (!end) return message_memory();
    for (; n < every; ++n) end[n] = (struct span_end){o->every * (double)n, true};
    for (int k = 0; k < given; ++k) end[n++] = (struct span_end){listed[k], true};
    for (size_t k = 0; k < n; ++k)
        if (!(end[k].time >= 0 && end[k].time <= o->until && (k == 0 || end[k].time > end[k - 1].time)))
            return message(STATUS_USAGE, "--times: %g is not above the time before, or not within 0 and %g s",
                           end[k].time, o->until);
    end[n++] = (struct span_end){o->until, !o->times};
    for (uint32_t k = 0; k < h->walls.count + 2; ++k) {
        const struct curve *curve = k < h->walls.count    ? &h->values.curve[k]
                                    : k == h->walls.count ? &h->given.ambient_curve
                                                          : &h->film.gas_curve;
        for (size_t p = 0; p < curve->n; ++p)
            if (curve->x[p] > 0 && curve->x[p] < o->until) end[n++] = (struct span_end){curve->x[p], false};
    }
    qsort(end, n, sizeof *end, number_order);
    *count = 0;
    for (size_t k = 0; k < n; ++k)
        if (*count > 0 && end[k].time == end[*count - 1].time)
            end[*count - 1].output |= end[k].output;
        else
            end[(*count)++] = end[k];
    return STATUS_OK;
}

/* What spheres of each type store, or what each sphere stores if capacities are in a column. */
static int make_stores(struct time_run *m) {
    static const double everywhere = 1;
    const struct time_options *o = &m->heat->time;
    const bool each = o->capacity.column && !o->capacity.types;
    const uint32_t n = m->heat->bed->n, types = o->capacity.types ? (uint32_t)o->capacity.types : 1;
    m->span.stores = each ? n : types;
    m->span.store = m->store = calloc(m->span.stores + (size_t)1, sizeof *m->store);
    m->span.store_of = m->store_of = calloc(n + (size_t)1, sizeof *m->store_of);
    m->melted = calloc(n + (size_t)1, sizeof *m->melted);
    if (!m->store || !m->store_of || !m->melted) return message_memory();
    m->span.melted = o->latent > 0 ? m->melted : NULL;
    for (uint32_t k = 0; k < m->span.stores; ++k) {
        const struct curve *curve = each ? NULL : &o->capacity.curve[k];
        m->store[k] =
            (fibrad_store){.melting = o->melting + m->heat->given.zero, .latent = o->latent, .width = o->width};
        if (curve && curve->n > 0)
            m->store[k].rows = (uint32_t)curve->n, m->store[k].temperature = curve->x, m->store[k].capacity = curve->y;
    }
    for (uint32_t i = 0; i < n; ++i) {
        m->store_of[i] = each ? i : (uint32_t)quantity_item(&o->capacity, m->heat->bed, i);
        fibrad_store *store = &m->store[m->store_of[i]];
        const double low = store->melting - o->width / 2, above = m->span.temperature[i] - low;
        m->melted[i] = o->width > 0 ? fmin(fmax(above / o->width, 0), 1) : above > 0;
        if (store->rows == 0 && m->specific[i] < INFINITY)
            store->rows = 1, store->temperature = &everywhere, store->capacity = &m->specific[i];
    }
    return STATUS_OK;
}

/* Heat capacities of the spheres [J/K], or masses [kg] if there are stores. */
static int find_capacities(struct time_run *m, double **capacity) {
    struct heat *h = m->heat;
    const char *file = h->options.name;
    double *density = NULL;
    int status =
        quantity_values(&h->time.capacity, h->bed, file, "heat capacity", 0, CAPACITY_LEAST, INFINITY, &m->specific);
    if (!status) status = quantity_values(&h->time.density, h->bed, file, "density", 0, 1e-12, 1e12, &density);
    if (!status) warn_matter(&h->options.warned, h->bed, m->specific, density);
    if (!status && (h->time.latent > 0 || quantity_curves(&h->time.capacity))) status = make_stores(m);
    if (!status) *capacity = malloc((h->bed->n + (size_t)1) * sizeof **capacity);
    if (!status && !*capacity) status = message_memory();
    for (uint32_t i = 0; i < h->bed->n && !status; ++i) {
        if (!(m->span.temperature[i] > 0))
            status =
                message_at(STATUS_INPUT, file, h->bed->line[i],
                           "the temperature is %g K; the initial temperature must be above 0", m->span.temperature[i]);
        const double r = h->bed->r[i] * h->bed->metres, store = m->specific[i] * density[i];
        const bool held = isinf(store);
        if (h->conductivity && !held) m->lag = fmax(m->lag, r * r * store / (M_PI * M_PI * h->conductivity[i]));
        (*capacity)[i] = m->store && !held ? density[i] : store;
        if (h->clumps.area)
            (*capacity)[i] *= heat_volume(h, i);
        else
            (*capacity)[i] = (*capacity)[i] * (4. / 3 * M_PI) * gsl_pow_3(r);
    }
    free(density);
    return status;
}

/* How finely powers are resolved. Exchange factors are corrected seldom, so their beams have more points. Patches serve
 * alone as fibrad_bed_advance says. Sets the law that surfaces follow. */
static fibrad_heat_config choose_beams(struct time_run *m) {
    enum { POINTS_CORRECTED = 128 };
    struct heat *h = m->heat;
    const struct contact_options *contacts = h->touching.options;
    const bool bends = contacts && (contacts->gas_curve.n > 0 || quantity_curves(&contacts->conductivity));
    bool alone = h->conductivity || contacts || h->films.any;
    fibrad_heat_config config = h->config;
    if (quantity_curves(&h->emissivities) || quantity_curves(&h->solid) || bends) {
        m->law = (fibrad_law){.follow = heat_follow, .context = h};
        m->span.law = &m->law;
        alone = true;
    }
    for (uint32_t k = 0; k < h->walls.count; ++k)
        alone = alone || isnan(h->sources.wall_temperature[k]) || m->wall_capacity[k] > 0;
    if (config.points == 0 && !alone) config.points = POINTS_CORRECTED;
    return config;
}

static int library_status(struct time_run *m, int status) {
    struct heat *h = m->heat;
    fibrad_fault fault;
    fibrad_bed_describe(h->made, NULL, &fault);
    const int refused = contacts_refuse(&h->touching, &h->options, h->bed, &h->walls, status, &fault);
    if (refused) return refused;
    const double time = m->points > 0 ? m->point[m->points - 1].time : m->now;
    if (status == FIBRAD_E_ARGUMENT && fault.why == FIBRAD_WHY_TEMPERATURE && m->store) {
        const fibrad_store *store = &m->store[m->store_of[fault.first]];
        progress_stop(&h->options.progress);
        return message_at(STATUS_INPUT, h->options.name, h->bed->line[fault.first],
                          "after %g s the temperature of sphere %lld is outside of the table of --heat-capacity, %g to "
                          "%g K",
                          time, (long long)bed_name(h->bed, fault.first), store->temperature[0],
                          store->temperature[store->rows - 1]);
    }
    if (status != FIBRAD_E_UNSOLVABLE) return bed_options_status(&h->options, h->bed, status, &fault);
    progress_stop(&h->options.progress);
    return message_at(STATUS_INPUT, h->options.name, 0, "after %g s no step keeps all temperatures above 0 K%s", time,
                      h->time.step > 0 ? "; --step auto takes shorter steps" : "");
}

/* Absorbed light heats surfaces all the time, by patches those that it falls on. An insulated wall would have to give
 * off as thermal radiation what it absorbs. */
static int absorb_light(struct time_run *m) {
    struct heat *h = m->heat;
    fibrad_fault fault;
    if (!h->lit.options) return STATUS_OK;
    for (uint32_t k = 0; k < h->walls.count; ++k)
        if (m->sources.insulated[k] && h->lit.of_walls[k] > 0)
            return message(STATUS_USAGE,
                           "--irradiate with --until: %s is insulated and needs --wall %s:insulated:absorptivity=0",
                           wall_name(&h->walls, k), wall_name(&h->walls, k));
    const int status = light_absorb(h, m->square_metres, &m->sources);
    fibrad_bed_describe(h->made, NULL, &fault);
    if (status) progress_stop(&h->options.progress);
    if (light_refuse(h, status, &fault)) return STATUS_USAGE;
    return bed_options_status(&h->options, h->bed, status, &fault);
}

/* Fluxes of triangles in W/m2: those of the library are in watts per area in the bed's unit of length. */
static int show_triangles(struct time_run *m) {
    struct side_arrays *triangles = &m->heat->triangles;
    double *flux = triangles->quantity[TRIANGLE_FLUX].side;
    if (triangles->count == 0) return FIBRAD_OK;
    const int status = fibrad_bed_sides(m->heat->made, flux, triangles->quantity[TRIANGLE_TEMPERATURE].side);
    for (size_t s = 0; s < 2 * (size_t)triangles->n; ++s) flux[s] /= m->square_metres;
    side_arrays_show(triangles);
    return status;
}

/* Computes the powers at m->now, and the temperatures of walls that have none given. shown: out, what was solved. */
static int solve_state(struct time_run *m, fibrad_heat_sources *shown) {
    struct heat *h = m->heat;
    *shown = m->sources;
    m->shown = m->now;
    for (uint32_t k = 0; k < h->walls.count; ++k)
        m->wall_power[k] = m->wall_capacity[k] > 0 || !shown->wall_power ? NAN : shown->wall_power[k];
    shown->wall_power = m->wall_power;
    film_at(h, m->now, m->now);
    shown->temperature = m->span.temperature;
    heat_follow(h, shown->temperature, m->wall, h->emissivity, NULL);
    heat_excess_of(h, shown->temperature, m->wall, m->excess);
    shown->power = NULL; /* a sphere has a temperature or a power, not both */
    return fibrad_bed_solve(h->made, shown, NULL, &h->result);
}

int time_write(struct time_run *m) {
    struct heat *h = m->heat;
    fibrad_heat_sources shown;
    int status = solve_state(m, &shown);
    if (!status) status = show_triangles(m);
    status = library_status(m, status);
    if (status) return status;
    for (uint32_t k = 0; k < h->walls.count; ++k)
        if (!isnan(m->wall[k])) h->result.wall_temperature[k] = m->wall[k];
    light_add(h);
    memcpy(h->result.temperature, m->span.temperature, h->bed->n * sizeof *m->span.temperature);
    for (uint32_t i = 0; i < h->bed->n; ++i)
        h->result.temperature_error[i] = NAN; /* this solution has not found them */
    if (isnan(h->given.surroundings)) shown.surroundings = NAN;
    status = heat_write(h, &m->bed, &(struct contents){.time = &m->now, .sources = &shown, .melted = m->span.melted});
    ++m->bed.frame;
    return status;
}

int time_try(struct time_run *m, double time) {
    struct heat *h = m->heat;
    outside_at(m, time, m->wall_next, &m->surroundings_next);
    m->span.duration = time - m->now;
    film_at(h, m->now, time);
    const int status = fibrad_bed_advance(h->made, &m->sources, &m->span);
    warn_made(&h->options.warned, h->bed, &h->walls, h->made, h->given.zero == 0);
    m->next = time;
    return status ? library_status(m, status) : STATUS_OK;
}

void time_keep(struct time_run *m) {
    m->steps += m->span.steps, m->refused += m->span.refused, m->sweeps += m->span.sweeps;
    m->corrections += m->span.corrections;
    m->error = fmax(m->error, m->span.error);
    for (uint32_t k = 0; k < m->heat->walls.count; ++k) m->energy[k] += m->wall_energy[k];
    m->surroundings_energy += m->span.surroundings_energy, m->gas_energy += m->span.gas_energy;
    m->held_energy += m->span.held_energy;
    for (uint32_t i = 0; i < m->bed.n; ++i) m->gained[i] += m->stored[i];
    for (uint32_t k = 0; k < m->heat->walls.count; ++k)
        m->wall[k] = m->wall_capacity[k] > 0 ? m->wall_end[k] : m->wall_next[k];
    m->sources.surroundings = m->surroundings_next;
    m->now = m->next;
}

/* Finds the temperatures of walls that have none given, for the summary. */
static int find_last_walls(struct time_run *m) {
    int status = STATUS_OK;
    for (uint32_t k = 0; k < m->heat->walls.count && !status; ++k) {
        fibrad_heat_sources shown;
        if (!isnan(m->wall[k])) continue;
        status = m->shown == m->now ? STATUS_OK : library_status(m, solve_state(m, &shown));
        m->wall[k] = m->heat->result.wall_temperature[k];
    }
    return status;
}

static void print_summary(struct time_run *m) {
    struct heat *h = m->heat;
    const struct time_options *o = &h->time;
    struct report *report = &h->options.report;
    double supplied = 0, stored = 0, exchanged = 0, melted = 0, mass = 0;
    bool held = false;
    const struct time_point end = point_of(m, m->now, m->span.temperature);
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        stored += m->gained[i], exchanged += fabs(m->gained[i]);
        supplied += m->now * m->sources.power[i];
        if (isinf(m->span.capacity[i]))
            held = true;
        else if (m->span.melted)
            melted += m->span.capacity[i] * m->melted[i], mass += m->span.capacity[i];
    }
    if (held) exchanged += fabs(m->held_energy);
    double balance = stored - supplied + m->surroundings_energy + m->gas_energy + m->held_energy;
    for (uint32_t k = 0; k < h->walls.count; ++k) balance += m->energy[k];
    bed_options_report(&h->options, h->bed, &h->walls, &h->facts);
    report_value(report, "until_s", m->now, 9);
    report_text(report, "model", m->corrections > 0 ? "corrected" : "patches");
    quantity_report(&h->emissivities, "emissivity", report);
    quantity_report(&h->solid, "solid_conductivity", report);
    if (m->lag > 0) report_value(report, "inner_lag_s", m->lag, 3);
    quantity_report(&o->capacity, "heat_capacity_J_kgK", report);
    quantity_report(&o->density, "density_kg_m3", report);
    if (h->given.ambient) report_value(report, "surroundings_K", m->sources.surroundings, 6);
    wall_values_report(&h->walls, m->wall, "_K", 6, report);
    wall_values_report(&h->walls, h->wall_emissivity, "_emissivity", 6, report);
    report_count(report, "threads", (uint64_t)(h->options.threads ? h->options.threads : omp_get_max_threads()));
    report_value(report, "seconds", progress_clock() - m->begun, 3);
    report_count(report, "steps", m->steps);
    report_count(report, "steps_refused", m->refused);
    report_count(report, "sweeps", m->sweeps);
    report_count(report, "corrections", m->corrections);
    report_value(report, "step_error", m->error, 2);
    report_value(report, "temperature_min_K", end.least, 6);
    report_value(report, "temperature_mean_K", end.mean, 6);
    report_value(report, "temperature_max_K", end.most, 6);
    report_value(report, "supplied_J", supplied, 6);
    report_value(report, "stored_J", stored, 6);
    if (held) report_value(report, "held_J", m->held_energy, 6);
    if (mass > 0) report_value(report, "melted", melted / mass, 6);
    if (h->given.ambient) report_value(report, "surroundings_J", m->surroundings_energy, 6);
    if (h->films.any) report_value(report, "gas_J", m->gas_energy, 6);
    stream_report(h);
    wall_values_report(&h->walls, m->energy, "_J", 6, report);
    light_report(h);
    contacts_report(&h->touching, h->bed, &h->walls, report);
    report_value(report, "balance_of_stored", exchanged > 0 ? balance / exchanged : 0, 2);
    report_end(report);
}

/* The inside of each sphere is taken to be steady. Warns if a sphere takes longer to become steady than a step, or than
 * the whole run. */
static void warn_lag(const struct time_run *m) {
    const double until = m->now, step = m->steps > 0 ? until / (double)m->steps : until;
    char than[80];
    if (m->lag > until)
        snprintf(than, sizeof than, "--until ends before, at %g s", until);
    else
        snprintf(than, sizeof than, "steps are shorter, %.3g s on the mean", step);
    if (m->lag > step)
        message_at(STATUS_OK, m->heat->options.name, 0,
                   "warning: --solid-conductivity: insides of spheres are taken to be steady, but become steady only "
                   "after up to %.3g s; %s",
                   m->lag, than);
}

/* Warns of tables whose ends the run has left. */
static void warn_tables(const struct time_run *m) {
    struct heat *h = m->heat;
    struct warned *warned = &h->options.warned;
    heat_warn_excess(h, m->excess);
    for (uint32_t k = 0; k < h->walls.count; ++k)
        warn_times(warned, wall_name(&h->walls, k), &h->values.curve[k], m->now);
    warn_times(warned, "--gas-temperature", &h->film.gas_curve, m->now);
    warn_times(warned, "--ambient", &h->given.ambient_curve, m->now);
}

int time_report(struct time_run *m) {
    struct heat *h = m->heat;
    int status = find_last_walls(m);
    if (!status && m->failed) status = message_memory();
    progress_stop(&h->options.progress);
    if (!status && h->options.outputs.picture) {
        memcpy(h->result.temperature, m->span.temperature, h->bed->n * sizeof *m->span.temperature);
        memcpy(h->result.wall_temperature, m->wall, h->walls.count * sizeof *m->wall);
        status =
            plot_time(&h->options.picture, h->options.name, m->point, m->points,
                      &(struct contents){.bed = h->bed, .walls = &h->walls, .result = &h->result}, &h->options.slice);
    }
    if (status) return status;
    warn_lag(m);
    warn_tables(m);
    print_summary(m);
    return STATUS_OK;
}

/* Sets up the span: what spheres store, and temperatures of gas that change. */
static int begin_span(struct time_run *m) {
    struct heat *h = m->heat;
    const uint32_t n = h->bed->n;
    double *now = calloc(3 * (size_t)n + 1, sizeof *now), *capacity = NULL;
    if (!now) return message_memory();
    memcpy(now, h->sources.temperature, n * sizeof *now);
    m->sources.temperature = now, m->sources.wall_temperature = m->wall;
    m->stored = now + n, m->gained = m->stored + n;
    m->span = (fibrad_span){.temperature = now, .stored = m->stored, .observe = note_point, .context = m};
    m->span.wall_temperature = m->wall_next, m->span.surroundings = &m->surroundings_next, m->span.step = h->time.step;
    m->span.wall_end = m->wall_end, m->span.wall_energy = m->wall_energy, m->span.wall_capacity = m->wall_capacity;
    if (h->film.gas_curve.n > 0) {
        m->span.gas = h->films.film && !h->sources.stream ? h->films.end : NULL;
        m->span.wall_gas = h->films.wall_end;
        m->span.inlet = h->sources.stream ? &h->films.inlet_end : NULL;
    }
    const int status = find_capacities(m, &capacity);
    m->span.capacity = capacity;
    return status;
}

int time_begin(struct time_run *m) {
    struct heat *h = m->heat;
    fibrad_heat_result *result = &h->result;
    m->begun = progress_clock(), m->shown = -1;
    m->bed = *h->bed, m->sources = h->sources, m->square_metres = h->bed->metres * h->bed->metres;
    m->bed.frame = 0, m->bed.timestep = -1;
    m->sources.sigma *= m->square_metres; /* areas are in the bed's unit of length, powers in watts */
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        m->wall_capacity[k] = h->walls.said[k].capacity;
        if (m->wall_capacity[k] > 0 && isnan(h->values.wall_power[k])) h->values.wall_power[k] = 0;
    }
    for (uint32_t i = 0; i < h->bed->n; ++i) result->power_error[i] = result->temperature_error[i] = NAN;
    result->surroundings_error = NAN;
    for (uint32_t k = 0; k < h->walls.count; ++k) result->wall_error[k] = result->wall_temperature_error[k] = NAN;
    int status = begin_span(m);
    if (status) return status;
    const fibrad_heat_config config = choose_beams(m);
    status = library_status(m, fibrad_bed_beams(h->made, &config));
    if (status) return status;
    fibrad_bed_describe(h->made, &h->facts, NULL);
    status = absorb_light(m);
    outside_at(m, 0, m->wall, &m->sources.surroundings);
    if (!status) note_point(m, 0, m->span.temperature);
    return status;
}

void time_end(struct time_run *m) {
    free(m->span.temperature);
    free((void *)m->span.capacity);
    free(m->specific);
    free(m->store);
    free(m->store_of);
    free(m->melted);
    free(m->point);
}

int heat_in_time(struct heat *h) {
    struct time_run m = {.heat = h};
    struct span_end *end = NULL;
    size_t count = 0;
    int status = time_begin(&m);
    if (!status) status = find_times(h, &end, &count);
    for (size_t k = 0; k < count && !status; ++k) {
        if (end[k].time > 0) status = time_try(&m, end[k].time);
        if (!status && end[k].time > 0) time_keep(&m);
        if (!status && end[k].output) status = time_write(&m);
    }
    if (!status) status = time_report(&m);
    progress_stop(&h->options.progress);
    free(end);
    time_end(&m);
    return status;
}
