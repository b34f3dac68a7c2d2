/* stepper.c - temperatures by implicit steps that keep the energy. SPDX-License-Identifier: MIT
 *
 * The scheme is SDIRK with two stages: singly diagonally implicit, of second order, L-stable and stiffly accurate
 * (R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006). With g = 1 - sqrt(1/2), the step h and f = (power + q(T))/C
 *
 *     T1 = T + g h f(T1),    T' = T + (1 - g) h f(T1) + g h f(T').
 *
 * Each stage solves C (T - base)/(g h) = power + q(T), where base is known. Newton's method makes the equation linear
 * in E = sigma T^4 about T*: a sphere gives off power + C (base - T*)/(g h) - storage (E - E*) with storage = C/(g h
 * dE/dT). Temperatures then follow from the powers q of that solution. The energy that the sum over spheres misses is
 * divided among them. So spheres lose what walls and surroundings gain, whatever the tolerance of the solution. The
 * embedded solution of first order differs by g h |f(T') - f(T1)|. This difference is kept below the tolerance; the
 * errors of second order add up to about the tolerance. docs/methods.md section 23.
 *
 * With a store the heat u for a capacity of 1 is in the place of T, and T follows from u: C (u - base)/(g h) = power +
 * q(T(u)), storage = C du/dT/(g h dE/dT). A sphere that melts at one temperature has du/dT = infinity. Its temperature
 * is then given in the linear problem, and u follows from q. If u leaves the melting range, the next guess is the heat
 * u of the linear problem, not that of its temperature. A wall with the capacity C gives off power + C (base - T)/(g
 * h), which is a film of gas at the temperature base. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/bed.h"
#include "simple/nearest.h"

#define GAMMA     0.29289321881345247560 /* 1 - sqrt(1/2) */
#define TOLERANCE 1e-4
#define SOLVED    1e-2 /* error of the solution of a stage over the tolerance */
#define RESIDUAL  .1   /* residual of a stage by patches over the tolerance: more would look like errors of the step */
#define GROWTH    5.0  /* largest ratio of a step to the last one */
#define SAFETY    0.9
#define SMALLEST  1e-12 /* shortest step over the span */
#define ROUNDING  1e-9  /* of temperatures at the ends of a table */
enum { NEWTON_MAX = 40, HALVED = 10 };

struct stepper {
    fibrad_bed *bed;
    fibrad_stepping *t;
    const fibrad_heat_sources *given;
    fibrad_span *span;
    double tolerance;
    fibrad_heat_sources sources; /* of the linear problem of a stage */
    fibrad_stream stream;        /* of the sources */
    fibrad_heat_result result;
    double *stage_walls[2], to_surroundings[2], to_gas[2],
        to_held[2];            /* powers of walls [walls], surroundings, gas, held spheres in each stage */
    fibrad_sections *sections; /* [span->stores] */
    size_t sides;              /* 2 triangles; 0: nothing is wanted of sides or of convection */
    double *side_temperature, *side_gas, *side_flux, *side_found, *side_energy; /* [sides], fluxes of two stages */
    double *convected, *convected_energy;                                       /* [spheres], the first of two stages */
    double *contact_temperature, *contact_flow, *contact_energy;                /* [contacts], flows of two stages */
};

static double power_of(const struct stepper *m, uint32_t i) { return m->given->power ? m->given->power[i] : 0; }

static bool is_held(const struct stepper *m, uint32_t i) { return m->span->capacity[i] == INFINITY; }

static bool wall_stores(const struct stepper *m, uint32_t b) {
    return m->span->wall_capacity && m->span->wall_capacity[b] > 0;
}

/* What sphere i is like at a heat, and the heat that it has at a temperature. */
static fibrad_stored stored_at(const struct stepper *m, uint32_t i, double heat) {
    if (!m->sections) return (fibrad_stored){heat, 1, 0};
    return fibrad_sections_at(&m->sections[m->span->store_of ? m->span->store_of[i] : 0], heat);
}

static double heat_at(const struct stepper *m, uint32_t i, double temperature, double melted) {
    if (!m->sections) return temperature;
    return fibrad_sections_heat(&m->sections[m->span->store_of ? m->span->store_of[i] : 0], temperature, melted);
}

/* The area of a triangle of a bed. */
static double area_of_triangle(const fibrad_triangles *mesh, size_t t) {
    const double *const at[] = {mesh->x, mesh->y, mesh->z};
    const uint32_t *corner = mesh->corner + 3 * t;
    double u[3], v[3], normal[3];
    for (int axis = 0; axis < 3; ++axis)
        u[axis] = at[axis][corner[1]] - at[axis][corner[0]], v[axis] = at[axis][corner[2]] - at[axis][corner[0]];
    cross(u, v, normal);
    return sqrt(inner(normal, normal)) / 2;
}

static double share_between(double from, double to, double share) { return from + share * (to - from); }

/* Sets n values at a share of the span. One that is missing at the beginning is constant. */
static void set_values(size_t n, double *now, const double *from, const double *to, double share) {
    for (size_t k = 0; to && k < n; ++k)
        now[k] = from && !isnan(from[k]) ? share_between(from[k], to[k], share) : to[k];
}

/* Sets the temperatures of walls, sides, surroundings and gas at a time since the beginning of the span. */
static void set_outside(struct stepper *m, double time) {
    const double share = time / m->span->duration;
    const fibrad_span *span = m->span;
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b)
        m->t->wall_stage[b] = wall_stores(m, b) ? NAN
                              : span->wall_temperature
                                  ? share_between(m->given->wall_temperature[b], span->wall_temperature[b], share)
                                  : m->given->wall_temperature[b];
    for (uint32_t i = 0; span->gas && i < m->bed->facts.spheres; ++i)
        m->t->gas[i] = share_between(m->given->gas[i], span->gas[i], share);
    for (uint32_t b = 0; m->given->wall_gas && b < m->bed->facts.walls; ++b)
        m->t->wall_gas[b] =
            span->wall_gas ? share_between(m->given->wall_gas[b], span->wall_gas[b], share) : m->given->wall_gas[b];
    set_values(m->sides, m->side_temperature, m->given->side_temperature, span->side_temperature, share);
    set_values(m->sides, m->side_gas, m->given->side_gas, span->side_gas, share);
    set_values(m->given->contacts, m->contact_temperature, m->given->contact_temperature, span->contact_temperature,
               share);
    if (span->inlet) m->stream.inlet = share_between(m->given->stream->inlet, *span->inlet, share);
    m->sources.surroundings =
        span->surroundings ? share_between(m->given->surroundings, *span->surroundings, share) : m->given->surroundings;
}

/* Sets emissivities at t->guess, which is near enough to the solution for second order. */
static void set_surfaces(struct stepper *m) {
    const fibrad_stepping *t = m->t;
    const fibrad_law *law = m->span->law;
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b)
        t->wall_seen[b] = wall_stores(m, b) ? t->wall_found[b] : t->wall_stage[b];
    if (law) law->follow(law->context, t->guess, t->wall_seen, t->emissivity, t->wall_emissivity);
}

/* The spheres of body b: the members of a clump, or one. */
static const uint32_t *members_of(const struct stepper *m, const uint32_t *b, uint32_t *count) {
    const fibrad_bodies *bodies = m->bed->bodies;
    *count = bodies ? bodies->start[*b + 1] - bodies->start[*b] : 1;
    return bodies ? bodies->member + bodies->start[*b] : b;
}

/* Whether a sphere exchanges no heat with any other. */
static bool stands_alone(const struct stepper *m, uint32_t i) {
    const fibrad_bodies *bodies = m->bed->bodies;
    if (bodies && bodies->start[bodies->body[i] + 1] - bodies->start[bodies->body[i]] > 1) return false;
    return m->sources.emissivity[i] == 0 && m->t->conducts[i] == 0;
}

/* Finds what contacts and films conduct from each sphere for each kelvin. */
static void find_conducts(struct stepper *m) {
    fibrad_stepping *t = m->t;
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) t->conducts[i] = m->given->film ? m->given->film[i] : 0;
    for (uint32_t k = 0; k < m->given->contacts; ++k) {
        const uint32_t i = m->given->contact_first[k], j = m->given->contact_second[k];
        if (i == j) continue;
        if (i < m->bed->facts.spheres) t->conducts[i] += m->given->conductance[k];
        if (j < m->bed->facts.spheres) t->conducts[j] += m->given->conductance[k];
    }
}

/* Makes the linear problem about t->guess. A sphere that exchanges no heat has no part in it. The temperature of a
 * sphere that is held, or melts at one temperature, is given. */
static void linearise(struct stepper *m, double length) {
    fibrad_stepping *t = m->t;
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) {
        const double at = t->guess[i], slope = stored_at(m, i, t->heat[i]).capacity;
        const double rate = m->span->capacity[i] / length;
        const bool fixed = stands_alone(m, i) || is_held(m, i) || slope == INFINITY;
        t->given[i] = fixed ? at : NAN;
        t->storage[i] = fixed ? 0 : rate * slope / (4 * m->given->sigma * at * at * at);
        t->source[i] = fixed ? 0 : power_of(m, i) + rate * (t->base[i] - t->heat[i]);
        t->allowed[i] = SOLVED * m->tolerance * rate * slope * at;
    }
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b) {
        const double own = m->given->wall_film ? m->given->wall_film[b] : 0;
        const double rate = wall_stores(m, b) ? m->span->wall_capacity[b] / length : 0;
        t->wall_film[b] = own + rate;
        t->wall_mixed[b] = rate > 0 ? (own * t->wall_gas[b] + rate * t->wall_base[b]) / (own + rate) : t->wall_gas[b];
    }
}

/* Capacity, given power and net power of the body of a sphere. */
typedef struct body_sum {
    double capacity, given, gained;
} body_sum;

static body_sum sum_of_body(const struct stepper *m, uint32_t i) {
    body_sum sum = {0, 0, 0};
    uint32_t count, b = m->bed->bodies ? m->bed->bodies->body[i] : i;
    const uint32_t *member = members_of(m, &b, &count);
    for (uint32_t k = 0; k < count; ++k)
        sum.capacity += m->span->capacity[member[k]], sum.given += power_of(m, member[k]),
            sum.gained += m->t->power[member[k]];
    return sum;
}

/* Takes the solution of the linear problem. t->solution gets the heats that keep the energy, t->heat and t->guess those
 * about which Newton's method goes on. Returns whether the two agree. halved: heats of what melts go half the way. */
static bool accept_solution(struct stepper *m, double length, bool halved) {
    fibrad_stepping *t = m->t;
    bool agree = true;
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) {
        const double at = t->guess[i], last = t->heat[i], ratio = t->found[i] / at;
        const body_sum body = sum_of_body(m, i);
        const double warmed = t->base[i] + length * body.given / body.capacity;
        const fibrad_stored from = stored_at(m, i, last);
        const bool alone = stands_alone(m, i), melts = from.capacity == INFINITY;
        t->solution[i] = is_held(m, i) ? last
                         : alone       ? warmed
                         : melts       ? warmed + length * body.gained / body.capacity
                                       : last + from.capacity * (0.25 * at * (ratio * ratio * ratio * ratio - 1));
        const fibrad_stored to = stored_at(m, i, t->solution[i]);
        const double found = alone ? to.temperature : t->found[i], near = found > at / 2 ? found : at / 2;
        agree = agree && near == found && fabs(found - to.temperature) <= SOLVED * m->tolerance * found;
        if (melts || to.melted != from.melted) {
            const double next = larger_of(t->solution[i], last / 2);
            t->heat[i] = halved ? (next + last) / 2 : next;
            t->guess[i] = stored_at(m, i, t->heat[i]).temperature;
        } else {
            t->guess[i] = near, t->heat[i] = heat_at(m, i, near, NAN);
        }
    }
    return agree;
}

/* Takes the temperatures of walls with a capacity. What their films convect is what they and their gas gain. */
static void accept_walls(struct stepper *m, double length) {
    fibrad_stepping *t = m->t;
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b) {
        if (!wall_stores(m, b)) continue;
        t->wall_found[b] = t->wall_mixed[b] - t->wall_convected[b] / t->wall_film[b];
        const double stored = m->span->wall_capacity[b] / length * (t->wall_found[b] - t->wall_base[b]);
        m->result.wall_power[b] = stored - t->wall_given[b], m->result.gas_power -= stored;
    }
}

/* Makes temperatures agree with powers. A slow sphere takes all of the energy that it misses. A fast one, which follows
 * its neighbours at once, takes little of it. The energy still missing warms all spheres alike, or walls if all are
 * held. */
static void balance_energy(struct stepper *m, double length) {
    fibrad_stepping *t = m->t;
    double left = -m->result.surroundings_power - m->result.gas_power, capacity = 0, of_walls = 0;
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b) {
        left -= m->result.wall_power[b];
        if (wall_stores(m, b)) of_walls += m->span->wall_capacity[b];
    }
    const uint32_t bodies = m->bed->bodies ? m->bed->bodies->n : m->bed->facts.spheres;
    for (uint32_t b = 0; b < bodies; ++b) {
        double missing = 0, stiff = 0;
        uint32_t count;
        const uint32_t *member = members_of(m, &b, &count);
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t i = member[k];
            const fibrad_stored to = stored_at(m, i, t->solution[i]);
            const double rate = m->span->capacity[i] / length, at = to.temperature;
            missing += power_of(m, i) + t->power[i] - rate * (t->solution[i] - t->base[i]);
            stiff +=
                rate + (4 * m->given->sigma * at * at * at * t->area[i] * m->sources.emissivity[i] + t->conducts[i]) /
                           to.capacity;
        }
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t i = member[k];
            if (is_held(m, i)) {
                left -= t->power[i];
                continue;
            }
            t->solution[i] += missing / stiff;
            left += power_of(m, i) - m->span->capacity[i] / length * (t->solution[i] - t->base[i]);
            capacity += m->span->capacity[i];
        }
    }
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i)
        if (!is_held(m, i)) t->solution[i] += left * length / capacity;
    for (uint32_t b = 0; b < m->bed->facts.walls && capacity == 0; ++b) {
        if (!wall_stores(m, b)) continue;
        t->wall_found[b] += left * length / of_walls;
        m->result.wall_power[b] += left * m->span->wall_capacity[b] / of_walls;
    }
}

static bool all_positive(const double *values, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i)
        if (!(values[i] > 0)) return false;
    return true;
}

/* Solves a stage that ends at `time` and starts at t->base. t->guess: where Newton's method begins. t->solution: out.
 * FIBRAD_E_UNSOLVABLE: a sphere would fall below 0 K. */
static int solve_stage(struct stepper *m, int stage, double time, double length) {
    fibrad_stepping *t = m->t;
    set_outside(m, time);
    m->result.wall_power = m->stage_walls[stage];
    if (m->convected) m->result.convected = m->convected + (size_t)stage * m->bed->facts.spheres;
    if (m->convected) m->result.contact_flow = m->contact_flow + (size_t)stage * m->given->contacts;
    for (int k = 0; k < NEWTON_MAX; ++k) {
        set_surfaces(m);
        find_conducts(m);
        linearise(m, length);
        const int status = fibrad_stepping_solve(m->bed, &m->sources, &m->result);
        if (status && status != FIBRAD_E_UNSOLVABLE) return status;
        m->span->sweeps += m->result.sweeps;
        accept_walls(m, length);
        if (!accept_solution(m, length, k >= HALVED) || status) continue;
        balance_energy(m, length);
        m->to_surroundings[stage] = m->result.surroundings_power, m->to_gas[stage] = m->result.gas_power;
        m->to_held[stage] = 0;
        for (uint32_t i = 0; i < m->bed->facts.spheres; ++i)
            if (is_held(m, i)) m->to_held[stage] += power_of(m, i) + t->power[i];
        if (m->sides > 0)
            (void)fibrad_heat_read_sides(m->bed->heat, m->side_flux + (size_t)stage * m->sides, m->side_found);
        for (uint32_t b = 0; b < m->bed->facts.walls; ++b)
            if (wall_stores(m, b) && !(t->wall_found[b] > 0)) return FIBRAD_E_UNSOLVABLE;
        return all_positive(t->solution, m->bed->facts.spheres) ? FIBRAD_OK : FIBRAD_E_UNSOLVABLE;
    }
    return FIBRAD_E_UNSOLVABLE;
}

/* Limits a guess to a factor of two about a temperature. */
static double near_to(double guess, double temperature) {
    return guess < temperature / 2 ? temperature / 2 : guess > 2 * temperature ? 2 * temperature : guess;
}

/* Tries a step. t->solution and *error: out. */
static int try_step(struct stepper *m, double time, double step, double *error) {
    fibrad_stepping *t = m->t;
    const double length = GAMMA * step;
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) {
        t->base[i] = t->now[i];
        t->heat[i] = is_held(m, i) ? t->now[i] : near_to(t->now[i] + length * t->slope[i], t->now[i]);
        t->guess[i] = stored_at(m, i, t->heat[i]).temperature;
    }
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b) t->wall_base[b] = t->wall_found[b] = t->wall_now[b];
    int status = solve_stage(m, 0, time + length, length);
    if (status) return status;
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) {
        const double change = t->solution[i] - t->now[i];
        t->first[i] = change;
        t->base[i] = t->now[i] + (1 - GAMMA) / GAMMA * change;
        t->heat[i] = near_to(t->now[i] + change / GAMMA, t->solution[i]);
        t->guess[i] = stored_at(m, i, t->heat[i]).temperature;
    }
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b)
        t->wall_base[b] = t->wall_now[b] + (1 - GAMMA) / GAMMA * (t->wall_found[b] - t->wall_now[b]);
    status = solve_stage(m, 1, time + step, length);
    *error = 0;
    for (uint32_t i = 0; i < m->bed->facts.spheres && !status; ++i)
        *error = larger_of(*error, fabs(t->solution[i] - t->base[i] - t->first[i]) / t->solution[i]);
    for (uint32_t b = 0; b < m->bed->facts.walls && !status; ++b) {
        const double first = GAMMA / (1 - GAMMA) * (t->wall_base[b] - t->wall_now[b]);
        if (wall_stores(m, b))
            *error = larger_of(*error, fabs(t->wall_found[b] - t->wall_base[b] - first) / t->wall_found[b]);
    }
    return status;
}

static void accept_step(struct stepper *m, double step, double error) {
    fibrad_stepping *t = m->t;
    fibrad_span *span = m->span;
    const double share[2] = {(1 - GAMMA) * step, GAMMA * step};
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) {
        t->slope[i] = (t->solution[i] - t->base[i]) / (GAMMA * step);
        t->now[i] = t->solution[i];
        t->warmth[i] = stored_at(m, i, t->now[i]).temperature;
    }
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b) t->wall_now[b] = t->wall_found[b];
    for (int stage = 0; stage < 2; ++stage) {
        for (uint32_t b = 0; b < m->bed->facts.walls; ++b)
            span->wall_energy[b] += share[stage] * m->stage_walls[stage][b];
        span->surroundings_energy += share[stage] * m->to_surroundings[stage];
        span->gas_energy += share[stage] * m->to_gas[stage];
        span->held_energy += share[stage] * m->to_held[stage];
        for (size_t k = 0; k < m->sides; ++k)
            m->side_energy[k] += share[stage] * m->side_flux[(size_t)stage * m->sides + k];
        for (size_t i = 0; m->convected && i < m->bed->facts.spheres; ++i)
            m->convected_energy[i] += share[stage] * m->convected[(size_t)stage * m->bed->facts.spheres + i];
        for (size_t k = 0; m->convected && k < m->given->contacts; ++k)
            m->contact_energy[k] += share[stage] * m->contact_flow[(size_t)stage * m->given->contacts + k];
    }
    span->error = larger_of(span->error, error);
    ++span->steps, ++t->steps;
}

/* The first step. The hottest surface would warm a sphere by its own temperature in a time; the step is sqrt(tolerance)
 * of the shortest such time. */
static double first_step(const struct stepper *m) {
    const fibrad_stepping *t = m->t;
    double hottest = m->given->surroundings, step = m->span->duration;
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b)
        hottest = larger_of(m->given->wall_temperature[b], hottest); /* NaN, not known: hottest stays */
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) hottest = larger_of(hottest, t->warmth[i]);
    const double emission = m->given->sigma * (hottest * hottest) * (hottest * hottest);
    for (uint32_t i = 0; i < m->bed->facts.spheres; ++i) {
        const double gas = m->given->stream ? m->given->stream->inlet : m->given->film ? m->given->gas[i] : 0;
        const double film = m->given->film ? m->given->film[i] * (gas - t->warmth[i]) : 0;
        const double rate = t->area[i] * m->given->emissivity[i] * emission + fabs(power_of(m, i)) + fabs(film);
        if (rate > 0) step = smaller_of(step, sqrt(m->tolerance) * m->span->capacity[i] * t->now[i] / rate);
    }
    return step;
}

/* Corrects factors by patches at the temperatures of now, if that is due. */
static int compare(struct stepper *m, double time) {
    fibrad_heat_sources now = *m->given;
    set_outside(m, time);
    now.temperature = m->t->warmth;
    now.wall_temperature = m->t->wall_stage, now.surroundings = m->sources.surroundings;
    return fibrad_stepping_compare(m->bed, &now, &m->span->corrections);
}

/* Finds a sphere that is beyond the table of its store. Then bed->fault is this sphere. */
static bool find_beyond(fibrad_bed *bed, const fibrad_span *span, const double *temperature) {
    for (uint32_t i = 0; i < bed->facts.spheres && span->store; ++i) {
        const fibrad_store *store = &span->store[span->store_of ? span->store_of[i] : 0];
        if (store->rows < 2 || (temperature[i] >= store->temperature[0] * (1 - ROUNDING) &&
                                temperature[i] <= store->temperature[store->rows - 1] * (1 + ROUNDING)))
            continue;
        bed->fault = (fibrad_fault){i, i, UINT32_MAX, 0, FIBRAD_WHY_TEMPERATURE};
        return true;
    }
    return false;
}

/* The next step of a span that begins. */
static double next_step(const struct stepper *m) {
    return m->span->step > 0 ? m->span->step : m->t->step > 0 ? m->t->step : first_step(m);
}

static int take_steps(struct stepper *m) {
    fibrad_stepping *t = m->t;
    fibrad_span *span = m->span;
    const bool fixed = span->step > 0;
    double next = next_step(m), time = 0, error;
    while (time < span->duration) {
        if (!(next > SMALLEST * span->duration)) return FIBRAD_E_UNSOLVABLE;
        const double rest = span->duration - time;
        const uint64_t parts = (uint64_t)(rest / next * (1 - 1e-9)) + 1; /* equal parts: no last step is much shorter */
        const double step = rest / (double)parts;
        int status = fibrad_team_report(&m->bed->team, "steps", span->steps, 0);
        if (!status) status = compare(m, time);
        if (!status) status = try_step(m, time, step, &error);
        if (status && (fixed || status != FIBRAD_E_UNSOLVABLE)) return status;
        const double wanted = status ? step / GROWTH : SAFETY * step * sqrt(m->tolerance / larger_of(error, 1e-300));
        if (status || (!fixed && error > m->tolerance)) {
            ++span->refused;
            next = larger_of(wanted, step / GROWTH);
            continue;
        }
        accept_step(m, step, error);
        if (find_beyond(m->bed, span, t->warmth)) return FIBRAD_E_ARGUMENT;
        time = parts > 1 ? time + step : span->duration;
        if (span->observe) span->observe(span->context, time, t->warmth);
        if (!fixed) next = smaller_of(wanted, larger_of(GROWTH * step, next));
    }
    if (!fixed) t->step = next;
    return FIBRAD_OK;
}

/* Checks stores, and walls with a capacity. */
static int check_stores(fibrad_bed *bed, const fibrad_heat_sources *s, const fibrad_span *span) {
    if (!span->store != (span->stores == 0)) return FIBRAD_E_ARGUMENT;
    for (uint32_t k = 0; k < span->stores; ++k)
        if (!fibrad_store_valid(&span->store[k])) return FIBRAD_E_ARGUMENT;
    for (uint32_t b = 0; b < bed->facts.walls && span->wall_capacity; ++b)
        if (!(span->wall_capacity[b] >= 0 && span->wall_capacity[b] <= FIBRAD_CAPACITY_MAX) ||
            (span->wall_capacity[b] > 0 && (!(s->wall_temperature[b] > 0) || (s->insulated && s->insulated[b]))))
            return FIBRAD_E_ARGUMENT;
    return find_beyond(bed, span, span->temperature) ? FIBRAD_E_ARGUMENT : FIBRAD_OK;
}

/* Whether a sphere stores heat as the first member of its clump does, and begins as it. */
static bool is_like_first(const fibrad_bed *bed, const fibrad_span *span, uint32_t i) {
    const uint32_t first = bed->bodies ? bed->bodies->member[bed->bodies->start[bed->bodies->body[i]]] : i;
    const double melted[] = {span->melted ? span->melted[i] : 0, span->melted ? span->melted[first] : 0};
    return span->temperature[i] == span->temperature[first] &&
           (span->capacity[i] == INFINITY) == (span->capacity[first] == INFINITY) &&
           (!span->store_of || span->store_of[i] == span->store_of[first]) &&
           (melted[0] == melted[1] || (isnan(melted[0]) && isnan(melted[1])));
}

/* Checks a span. bed->fault: the first sphere with an invalid value. */
static int check_span(fibrad_bed *bed, const fibrad_heat_sources *s, const fibrad_span *span) {
    const uint32_t n = bed->facts.spheres, walls = bed->facts.walls;
    if (n > 0 && (!span->temperature || !span->capacity || !s->emissivity)) return FIBRAD_E_ARGUMENT;
    if (walls > 0 && !(s->wall_temperature && s->wall_emissivity)) return FIBRAD_E_ARGUMENT;
    if (!(span->duration > 0 && span->duration <= FIBRAD_DURATION_MAX && span->step >= 0 && span->tolerance >= 0 &&
          span->tolerance < 1) ||
        (span->law && !span->law->follow))
        return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < n; ++i) {
        const double capacity = span->capacity[i];
        const int why = !(span->temperature[i] > 0 && span->temperature[i] <= FIBRAD_TEMPERATURE_MAX)
                            ? FIBRAD_WHY_TEMPERATURE
                        : !(capacity > 0 && (capacity <= FIBRAD_CAPACITY_MAX || capacity == INFINITY)) ||
                                (span->store_of && span->store_of[i] >= span->stores)
                            ? FIBRAD_WHY_CAPACITY
                        : s->power && !(fabs(s->power[i]) <= FIBRAD_POWER_MAX) ? FIBRAD_WHY_POWER
                        : !(s->emissivity[i] >= 0 && s->emissivity[i] <= 1)    ? FIBRAD_WHY_EMISSIVITY
                        : !is_like_first(bed, span, i)                         ? FIBRAD_WHY_CLUMP_HEAT
                                                                               : 0;
        if (why) bed->fault = (fibrad_fault){i, i, UINT32_MAX, 0, why};
        if (why) return FIBRAD_E_ARGUMENT;
    }
    if (s->contacts > 0 && !(s->contact_first && s->contact_second && s->conductance)) return FIBRAD_E_ARGUMENT;
    for (uint32_t k = 0; k < s->contacts; ++k)
        if (s->contact_first[k] >= n + walls || s->contact_second[k] >= n + walls) return FIBRAD_E_ARGUMENT;
    if (s->film && !s->gas && !s->stream) return FIBRAD_E_ARGUMENT;
    if (span->side_gas && !(s->side_gas && s->side_film)) return FIBRAD_E_ARGUMENT;
    if (span->contact_temperature && !s->contact_temperature) return FIBRAD_E_ARGUMENT;
    if ((span->gas && !s->gas) || ((span->wall_gas || s->wall_film) && !s->wall_gas) || (span->inlet && !s->stream))
        return FIBRAD_E_ARGUMENT;
    return check_stores(bed, s, span);
}

/* Whether a span has or wants what only patches tell. */
static bool wants_more(const fibrad_span *span) {
    return span->side_temperature || span->side_gas || span->side_energy || span->side_end || span->convected_energy ||
           span->contact_temperature || span->contact_energy;
}

/* Whether exchange factors can stand for patches: surfaces stay as they are, spheres have one temperature each, no
 * contacts, no films and no clumps, and the temperatures of walls and surroundings are known. */
static bool factors_suffice(const fibrad_bed *bed, const fibrad_heat_sources *s, const fibrad_span *span) {
    bool suffice = !span->law && !s->conductivity && s->contacts == 0 && !s->film && !s->wall_film && !bed->bodies;
    suffice = suffice && !s->side_film && !s->side_power && !wants_more(span) && s->surroundings >= 0 &&
              s->surroundings <= FIBRAD_TEMPERATURE_MAX;
    for (uint32_t b = 0; b < bed->facts.walls; ++b)
        suffice = suffice && s->wall_temperature[b] >= 0 && s->wall_temperature[b] <= FIBRAD_TEMPERATURE_MAX &&
                  !(s->insulated && s->insulated[b]) && !(span->wall_capacity && span->wall_capacity[b] > 0);
    return suffice;
}

/* Turns what sides gain per area into what they gain. What their wall gains besides, through its film and contacts that
 * have no temperature of their own, is spread evenly. */
static void share_out_walls(const struct stepper *m, fibrad_span *span) {
    const fibrad_triangles *mesh = m->bed->config.triangles;
    double left[FIBRAD_WALLS_MAX], area[FIBRAD_WALLS_MAX] = {0};
    memcpy(left, m->span->wall_energy, m->bed->facts.walls * sizeof *left);
    for (uint32_t k = 0; m->given->contact_temperature && k < m->given->contacts; ++k)
        if (!isnan(m->given->contact_temperature[k]))
            left[m->given->contact_second[k] - m->bed->facts.spheres] -= m->contact_energy[k];
    for (int pass = 0; pass < 2; ++pass)
        for (size_t k = 0; k < m->sides; ++k) {
            const uint32_t t = (uint32_t)(k / 2), b = k % 2 == 0   ? mesh->front[t]
                                                      : mesh->back ? mesh->back[t]
                                                                   : UINT32_MAX;
            const double own = area_of_triangle(mesh, t);
            if (b >= m->bed->facts.walls || isnan(m->side_energy[k])) continue;
            if (pass == 0)
                left[b] -= own * m->side_energy[k], area[b] += own;
            else
                m->side_energy[k] = own * (m->side_energy[k] + (m->given->absorbed ? 0 : left[b] / area[b]));
        }
    if (span->side_energy) memcpy(span->side_energy, m->side_energy, m->sides * sizeof *left);
    if (span->side_end) memcpy(span->side_end, m->side_found, m->sides * sizeof *left);
}

/* Writes what a span has come to. */
static void end_span(const struct stepper *m, fibrad_span *span) {
    const fibrad_stepping *t = m->t;
    const uint32_t n = m->bed->facts.spheres, walls = m->bed->facts.walls;
    const fibrad_span given = *span;
    *span = *m->span;
    span->wall_energy = given.wall_energy, span->surroundings_power = m->to_surroundings[1];
    span->gas_power = m->to_gas[1];
    for (uint32_t i = 0; i < n; ++i) {
        const double begun = heat_at(m, i, span->temperature[i], span->melted ? span->melted[i] : NAN);
        if (span->stored) span->stored[i] = is_held(m, i) ? 0 : m->span->capacity[i] * (t->now[i] - begun);
        if (span->melted) span->melted[i] = stored_at(m, i, t->now[i]).melted;
        span->temperature[i] = t->warmth[i];
    }
    if (m->sides > 0) share_out_walls(m, span);
    if (span->convected_energy && n > 0) memcpy(span->convected_energy, m->convected_energy, n * sizeof *t->power);
    if (span->contact_energy && m->given->contacts > 0)
        memcpy(span->contact_energy, m->contact_energy, m->given->contacts * sizeof *t->power);
    if (span->power) memcpy(span->power, t->power, n * sizeof *t->power);
    for (uint32_t b = 0; b < walls; ++b) {
        if (span->wall_power) span->wall_power[b] = m->stage_walls[1][b];
        if (span->wall_energy) span->wall_energy[b] = m->span->wall_energy[b];
        if (span->wall_end) span->wall_end[b] = wall_stores(m, b) ? t->wall_now[b] : t->wall_stage[b];
    }
    for (uint32_t i = 0; i < n && span->law && span->law->emissivity; ++i) span->law->emissivity[i] = t->emissivity[i];
    for (uint32_t b = 0; b < walls && span->law && span->law->wall_emissivity; ++b)
        span->law->wall_emissivity[b] = t->wall_emissivity[b];
}

/* Makes the sections of all stores, in one block, and finds the heats of spheres. */
static int begin_stores(struct stepper *m, const fibrad_span *span) {
    fibrad_stepping *t = m->t;
    const uint32_t n = m->bed->facts.spheres;
    size_t room = 0;
    for (uint32_t k = 0; k < span->stores; ++k) room += span->store[k].rows + 3;
    if (span->stores > 0) m->sections = malloc(span->stores * sizeof *m->sections + room * sizeof(fibrad_section));
    if (span->stores > 0 && !m->sections) return FIBRAD_E_MEMORY;
    fibrad_section *section = m->sections ? (fibrad_section *)(m->sections + span->stores) : NULL;
    for (uint32_t k = 0; k < span->stores; section += m->sections[k++].n) {
        m->sections[k].section = section;
        fibrad_sections_make(&m->sections[k], &span->store[k]);
    }
    for (uint32_t i = 0; i < n; ++i) {
        t->warmth[i] = span->temperature[i];
        t->now[i] = heat_at(m, i, t->warmth[i], span->melted ? span->melted[i] : NAN);
    }
    return FIBRAD_OK;
}

/* Lets films stand for the capacities of walls. */
static void begin_walls(struct stepper *m) {
    fibrad_stepping *t = m->t;
    const fibrad_heat_sources *s = m->given;
    bool any = false;
    for (uint32_t b = 0; b < m->bed->facts.walls; ++b) {
        const double power = s->wall_power ? s->wall_power[b] : NAN;
        t->wall_given[b] = wall_stores(m, b) && isnan(power) ? 0 : power;
        t->wall_now[b] = t->wall_found[b] = s->wall_temperature[b];
        any = any || wall_stores(m, b);
    }
    if (!any) return;
    m->sources.wall_power = t->wall_given;
    m->sources.wall_film = t->wall_film, m->sources.wall_gas = t->wall_mixed;
    m->result.wall_convected = t->wall_convected;
}

/* Takes memory for sides, convection and contacts. */
static int begin_more(struct stepper *m, const fibrad_span *span) {
    const size_t n = m->bed->facts.spheres, contacts = m->given->contacts,
                 sides = m->bed->config.triangles ? 2 * (size_t)m->bed->config.triangles->n : 0;
    if (!wants_more(span)) return FIBRAD_OK;
    double *block = calloc(6 * sides + 3 * n + 4 * contacts + 1, sizeof *block);
    if (!block) return FIBRAD_E_MEMORY;
    m->sides = sides;
    m->side_temperature = block, m->side_gas = block + sides, m->side_found = block + 2 * sides;
    m->side_energy = block + 3 * sides, m->side_flux = block + 4 * sides;
    m->convected_energy = block + 6 * sides, m->convected = m->convected_energy + n;
    m->contact_temperature = m->convected + 2 * n, m->contact_energy = m->contact_temperature + contacts;
    m->contact_flow = m->contact_energy + contacts;
    if (span->side_temperature) m->sources.side_temperature = m->side_temperature;
    if (span->side_gas) m->sources.side_gas = m->side_gas;
    if (span->contact_temperature) m->sources.contact_temperature = m->contact_temperature;
    return FIBRAD_OK;
}

/* Exchange factors pay from the third step at the same positions on. */
enum { STEPS_BY_PATCHES = 2 };

static int advance_span(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_span *span) {
    fibrad_stepping *t = &bed->stepping;
    const uint32_t n = bed->facts.spheres, walls = bed->facts.walls;
    fibrad_span now = *span;
    struct stepper m = {.bed = bed, .t = t, .given = sources, .span = &now, .sources = *sources};
    m.tolerance = span->tolerance > 0 ? span->tolerance : TOLERANCE;
    m.result.power = t->power, m.result.temperature = t->found;
    for (size_t k = 0; k < 2; ++k) m.stage_walls[k] = t->wall_stage + (k + 1) * walls;
    m.sources.temperature = t->given, m.sources.power = t->source;
    m.sources.storage = t->storage, m.sources.reference = t->guess;
    m.sources.wall_temperature = t->wall_stage, m.sources.no_errors = 1;
    if (span->gas) m.sources.gas = t->gas;
    if (span->wall_gas) m.sources.wall_gas = t->wall_gas;
    begin_walls(&m);
    if (sources->stream) m.stream = *sources->stream, m.sources.stream = &m.stream;
    if (!(m.sources.tolerance > 0)) m.sources.tolerance = RESIDUAL * m.tolerance;
    int status = begin_stores(&m, span);
    if (!status) status = begin_more(&m, span);
    if (status) {
        free(m.sections);
        return status;
    }
    t->by_factors = factors_suffice(bed, sources, span) &&
                    (t->network || (double)t->steps + span->duration / next_step(&m) > STEPS_BY_PATCHES);
    status = fibrad_stepping_prepare(bed, sources);
    if (span->law) {
        memcpy(t->emissivity, sources->emissivity, n * sizeof *t->emissivity);
        for (uint32_t b = 0; b < walls; ++b) t->wall_emissivity[b] = sources->wall_emissivity[b];
        m.sources.emissivity = t->emissivity, m.sources.wall_emissivity = t->wall_emissivity;
    }
    now.surroundings_energy = now.gas_energy = now.held_energy = now.error = 0;
    now.steps = now.refused = now.sweeps = now.corrections = 0;
    now.wall_energy = t->wall_stage + 3 * (size_t)walls;
    for (uint32_t b = 0; b < walls; ++b) now.wall_energy[b] = 0;
    if (!status) status = take_steps(&m);
    if (!status) end_span(&m, span);
    free(m.sections);
    free(m.side_temperature);
    return status;
}

int fibrad_bed_advance(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_span *span) {
    if (!bed || !sources || !span) return FIBRAD_E_ARGUMENT;
    int status = fibrad_bed_begin(bed);
    if (status) return status;
    status = check_span(bed, sources, span);
    if (!status) status = fibrad_stepping_make(bed);
    if (!status) fibrad_bed_warn_of_sources(bed, sources, span->temperature);
    if (!status && !span->store) fibrad_bed_warn_of_stores(bed, span->capacity);
    if (!status) status = advance_span(bed, sources, span);
    return fibrad_bed_end(bed, status);
}
