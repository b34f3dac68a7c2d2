/* radiation.c - what the fix of LAMMPS and the driver of LIGGGHTS have in common. SPDX-License-Identifier: MIT */
#include "couple/simulation/radiation.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "simple/cylinder.h"
#include "couple/insitu.h"
#include "text/read_number.h"

/* Keeps a sentence. Returns false. */
__attribute__((format(printf, 2, 3))) static bool refuse(struct radiation *r, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r->fault, sizeof r->fault, format, arguments);
    va_end(arguments);
    return false;
}

/* ---- words ------------------------------------------------------------------------------------------------------ */

bool radiation_number(const char *word, double low, double high, double *value) {
    return number_read(word, value) && *value >= low && *value <= high;
}

bool radiation_whole(const char *word, int64_t low, int64_t high, int64_t *value) {
    return number_read_whole(word, value) && *value >= low && *value <= high;
}

const char *radiation_option(struct radiation *r, const char *name, const char *word) {
    fibrad_insitu_config *c = &r->config;
    int64_t whole = 0;
    if (strcmp(name, "cutoff") == 0)
        return radiation_number(word, 0, FIBRAD_LENGTH_MAX, &c->cutoff) ? NULL : "a length of 0 or more";
    if (strcmp(name, "tolerance") == 0) return radiation_number(word, 0, 1, &c->tolerance) ? NULL : "within 0 and 1";
    if (strcmp(name, "seed") == 0) {
        const bool good = radiation_whole(word, 0, INT64_MAX, &whole);
        c->seed = (uint64_t)whole;
        return good ? NULL : "a whole number";
    }
    if (strcmp(name, "threads") == 0) {
        const bool good = radiation_whole(word, 1, 1024, &whole);
        c->threads = (int)whole;
        return good ? NULL : "a number of threads, 1 to 1024";
    }
    if (strcmp(name, "strict") == 0) {
        c->strict = strcmp(word, "yes") == 0;
        return c->strict || strcmp(word, "no") == 0 ? NULL : "yes or no";
    }
    if (strcmp(name, "accuracy") != 0) return "";
    r->accuracy = true;
    c->accuracy = fibrad_accuracy_named(word);
    return c->accuracy >= 0 ? NULL : "one of low, normal and high";
}

int radiation_contact_words(struct radiation *r, const char *const *word, int count) {
    int at = 0;
    while (at < count) {
        const bool hertz = strcmp(word[at], "hertz") == 0, scale = strcmp(word[at], "scale") == 0;
        const bool wall = strcmp(word[at], "wall") == 0; /* of a shape, it begins a wall */
        if (hertz || strcmp(word[at], "lens") == 0) {
            r->spots.hertz = hertz, at += 1;
            continue;
        }
        const char *value = at + 1 < count ? word[at + 1] : "";
        double number;
        if (strcmp(word[at], "gas") == 0 && *value == '@') {
            snprintf(r->gas_file, sizeof r->gas_file, "%s", value + 1);
            at += 2;
            continue;
        }
        if (!scale && strcmp(word[at], "gas") != 0 && !(wall && number_read(value, &number))) break;
        if (!radiation_number(value,
                              scale  ? 1e-6
                              : wall ? 1e-300
                                     : 0,
                              scale ? 1e6 : 1e300,
                              scale  ? &r->spots.scale
                              : wall ? &r->spots.wall
                                     : &r->spots.gas)) {
            refuse(r, "%s, not `%s`",
                   scale  ? "the scale of contacts must be in [1e-6, 1e6]"
                   : wall ? "the conductivity of walls at contacts must be above 0"
                          : "the conductivity of the gas must be 0 or more",
                   value);
            return -1;
        }
        at += 2;
    }
    return at;
}

bool radiation_units(struct radiation *r, const char *style) {
    const bool cgs = strcmp(style, "cgs") == 0;
    if (!cgs && strcmp(style, "si") != 0) return false;
    r->sigma = FIBRAD_STEFAN_BOLTZMANN * (cgs ? 1e3 : 1);
    r->spots.gas_least = FIBRAD_GAS_LEAST_DEFAULT * (cgs ? 100 : 1);
    return true;
}

/* ---- walls ------------------------------------------------------------------------------------------------------ */

/* 2 axis + upper of a plane. Else -1. */
static int side_of(const struct wall_words *w) {
    return w->shape == WALL_PLANE ? 2 * w->wall.plane.axis + w->wall.plane.upper : -1;
}

/* Checks what is said of temperatures. */
static bool check_wall(struct radiation *r, const struct wall_words *w) {
    const bool of_simulation = r->files ? w->temperature_text && strncmp(w->temperature_text, "v_", 2) == 0
                                        : w->shape == WALL_MESH && !w->temperature_text;
    if (w->temperature_text && !of_simulation && !(w->temperature >= 0 && w->temperature <= FIBRAD_TEMPERATURE_MAX))
        return refuse(r, "wall %s: temperature: `%s` is not a temperature", w->word, w->temperature_text);
    if (r->heats && !of_simulation && !(w->given & (WALL_TEMPERATURE | WALL_INSULATED | WALL_OPEN)))
        return refuse(r, "wall %s: it needs a temperature, or the word insulated", w->word);
    if (w->given & WALL_INSULATED && w->given & (WALL_CAPACITY | WALL_EMISSIVITY))
        return refuse(r, "wall %s: insulated excludes capacity and emissivity", w->word);
    if (w->given & WALL_CAPACITY && w->temperature_text && r->files && of_simulation)
        return refuse(r, "wall %s: a wall with a capacity has a temperature of its own, not %s", w->word,
                      w->temperature_text);
    if (w->given & WALL_INSULATED && r->conducts)
        return refuse(r, "wall %s: contacts conduct at a temperature; say one and emissivity 0", w->word);
    return true;
}

bool radiation_add_wall(struct radiation *r, const struct wall_words *words) {
    const bool box = words->shape == WALL_BOX || words->shape == WALL_AUTO;
    for (int side = 0; side < (box ? 6 : 1); ++side) {
        struct radiation_item item = {*words, box};
        if (box) {
            item.words.shape = WALL_PLANE, item.words.word = wall_plane_names[side];
            item.words.wall = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {side / 2, side % 2, NAN}};
        }
        uint32_t k = 0;
        while (k < r->items && !(side_of(&item.words) >= 0 && side_of(&item.words) == side_of(&r->item[k].words))) ++k;
        if (k == sizeof r->item / sizeof *r->item) return refuse(r, "there are at most %d walls", FIBRAD_WALLS_MAX);
        r->item[k] = item;
        if (k == r->items) r->items++;
    }
    return true;
}

/* The name of the next wall. */
static const char *name_of(const struct radiation *r, const struct wall_words *w) {
    if (w->shape == WALL_PLANE) return wall_plane_names[side_of(w)];
    if (w->shape == WALL_CYLINDER) return w->word;
    return r->files ? r->meshes.meshes.name[r->walls] : w->mesh.path;
}

/* Adds `count` walls of some words. */
static bool push_walls(struct radiation *r, const struct wall_words *w, uint32_t count) {
    for (uint32_t k = 0; k < count; ++k, ++r->walls) {
        if (r->walls == FIBRAD_WALLS_MAX) return refuse(r, "there are at most %d walls", FIBRAD_WALLS_MAX);
        r->wall[r->walls] = w->wall;
        r->words[r->walls] = w;
        r->temperature[r->walls] = w->given & WALL_TEMPERATURE || r->heats ? w->temperature : 0;
        r->emissivity[r->walls] = w->emissivity;
        if (w->given & WALL_INSULATED) r->temperature[r->walls] = r->emissivity[r->walls] = 0;
        r->name[r->walls] = name_of(r, w);
    }
    return true;
}

static bool make_walls(struct radiation *r, const int periodic[3]) {
    for (uint32_t k = 0; k < r->items; ++k) {
        const struct wall_words *w = &r->item[k].words;
        uint32_t count = 1;
        if (r->item[k].of_box && periodic[w->wall.plane.axis]) continue;
        if (!check_wall(r, w)) return false;
        if (w->given & WALL_OPEN) {
            if (periodic[w->wall.plane.axis]) return refuse(r, "wall %s: its axis is periodic", w->word);
            r->opening[r->openings++] = w->wall.plane;
            continue;
        }
        if (w->shape == WALL_MESH && r->files) {
            if (w->mesh.name && !mesh_name(w->mesh.name))
                return refuse(r, "a wall cannot be called `%s`: letters, digits and _, at most 31", w->mesh.name);
            if (mesh_walls_add(&r->meshes, r->comm, &w->mesh, NULL, r->walls, &count))
                return refuse(r, "%s", *r->meshes.messages ? r->meshes.messages : w->mesh.path);
            if (*r->meshes.messages) r->say(r->simulation, r->meshes.messages, false);
        }
        if (!push_walls(r, w, count)) return false;
    }
    return true;
}

static void keep_sentence(void *fault, const char *line) { snprintf(fault, 2 * WALL_FAULT, "%s", line); }

bool radiation_table(struct radiation *r, const char *path, const char *what, double low, double high,
                     struct curve *curve) {
    int rank, size[2] = {0};
    MPI_Comm_rank(r->comm, &rank);
    *curve = (struct curve){0};
    if (rank == 0) {
        message_redirect(keep_sentence, r->fault);
        size[0] = curve_read(path, what, &curve_values, low, high, curve), size[1] = (int)curve->n;
        message_redirect(NULL, NULL);
    }
    MPI_Bcast(size, 2, MPI_INT, 0, r->comm);
    MPI_Bcast(r->fault, sizeof r->fault, MPI_CHAR, 0, r->comm);
    if (size[0]) return false;
    if (rank > 0) {
        curve->n = (size_t)size[1];
        curve->x = malloc(curve->n * sizeof(double)), curve->y = malloc(curve->n * sizeof(double));
    }
    if (fibrad_agree(r->comm, curve->x && curve->y ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL))
        return refuse(r, "out of memory");
    MPI_Bcast(curve->x, size[1], MPI_DOUBLE, 0, r->comm);
    MPI_Bcast(curve->y, size[1], MPI_DOUBLE, 0, r->comm);
    return true;
}

bool radiation_begin(struct radiation *r, MPI_Comm comm, const int periodic[3]) {
    r->comm = comm;
    if (r->accuracy && r->config.tolerance > 0) return refuse(r, "accuracy excludes tolerance");
    if (r->heats && !(r->surroundings >= 0))
        return refuse(r, "surroundings T is missing, the temperature of what surrounds the particles");
    if (!make_walls(r, periodic)) return false;
    if (*r->gas_file && !radiation_table(r, r->gas_file, "conductivity of the gas", 0, 1e300, &r->gas)) return false;
    r->spots.gas_temperature = r->gas.x, r->spots.gas_conductivity = r->gas.y;
    r->spots.gas_rows = (uint32_t)r->gas.n;
    if (fibrad_insitu_new(&r->insitu, comm, &r->config)) return refuse(r, "out of memory");
    return true;
}

bool radiation_place(struct radiation *r, const double low[3], const double high[3], const int periodic[3],
                     const int boundary[3][2]) {
    for (uint32_t k = 0; k < r->walls; ++k) {
        const struct wall_words *w = r->words[k];
        const int axis = w->wall.plane.axis, upper = w->wall.plane.upper;
        const int across[] = {cylinder_across(&w->wall, 0), cylinder_across(&w->wall, 1)};
        if (w->shape == WALL_CYLINDER && (periodic[across[0]] || periodic[across[1]]))
            return refuse(r, "wall %s needs open axes %c and %c: what is in it has no images beyond it", w->word,
                          "xyz"[across[0]], "xyz"[across[1]]);
        if (w->shape != WALL_PLANE || w->given & WALL_AT) continue;
        if (periodic[axis]) return refuse(r, "wall %s: its axis is periodic", w->word);
        if (boundary[axis][upper] != 1)
            return refuse(r, "wall %s: the box has no fixed end there; say where, at=POS", w->word);
        r->wall[k].plane.at = (upper ? high : low)[axis];
    }
    for (uint32_t k = 0; k < r->openings; ++k) {
        fibrad_plane *opening = &r->opening[k];
        if (isnan(opening->at) && boundary[opening->axis][opening->upper] == 1) opening->at = INFINITY;
    }
    return true;
}

fibrad_insitu_bed radiation_bed(const struct radiation *r, const double low[3], const double high[3],
                                const int periodic[3]) {
    fibrad_insitu_bed bed = {.wall = r->wall, .wall_emissivity = r->emissivity, .walls = r->walls};
    bed.opening = r->opening, bed.openings = r->openings, bed.triangles = &r->meshes.meshes.triangles;
    for (int a = 0; a < 3; ++a) bed.low[a] = low[a], bed.high[a] = high[a], bed.periodic[a] = periodic[a];
    return bed;
}

/* ---- rows and powers -------------------------------------------------------------------------------------------- */

/* Takes a status of fibrad_insitu. Tells once of each kind what was done with strays. */
static bool take(struct radiation *r, int status, uint64_t step) {
    const char *hint = status == FIBRAD_E_BACK      ? "; with the word `both` both sides of a mesh are the wall"
                       : status == FIBRAD_E_ENDLESS ? ", `zmax open` for example"
                                                    : "";
    if (status) return refuse(r, "step %" PRIu64 ": %s%s", step, fibrad_insitu_message(r->insitu), hint);
    for (int kind = 0; kind < FIBRAD_REMARKS; ++kind) {
        const char *remark = fibrad_insitu_remark(r->insitu, kind);
        char sentence[2 * WALL_FAULT];
        if (!*remark || r->told[kind]) continue;
        snprintf(sentence, sizeof sentence, "%s, at step %" PRIu64 "; %s", remark, step,
                 kind == FIBRAD_REMARK_BEYOND ? "take a larger `cutoff`"
                                              : "with the option `strict` this ends the run");
        r->say(r->simulation, sentence, true);
        r->told[kind] = true;
    }
    return true;
}

bool radiation_check(struct radiation *r, const fibrad_insitu_bed *bed) {
    fibrad_insitu_build b = {.s = r->insitu, .to = &r->insitu->next, .bed = bed};
    return take(r, fibrad_insitu_check(&b), 0);
}

bool radiation_rows(struct radiation *r, const fibrad_insitu_bed *bed, uint64_t step, bool follow) {
    r->place_meshes(r->simulation);
    if (bed->clump && !radiation_agree(r, bed, bed->emissivity, "emissivities")) return false;
    if (mesh_walls_face(&r->meshes, r->comm, bed)) return refuse(r, "out of memory");
    *(follow ? &r->rows_followed : &r->rows_made) += 1;
    return take(r, (follow ? fibrad_insitu_follow : fibrad_insitu_rows)(r->insitu, bed, step), step);
}

bool radiation_sums(struct radiation *r, const fibrad_insitu_bed *bed, double *value, int width) {
    const int status = fibrad_clump_sums(r->comm, bed->clump, bed->id, bed->n, value, width);
    return !status || refuse(r, "out of memory");
}

bool radiation_agree(struct radiation *r, const fibrad_insitu_bed *bed, const double *value, const char *values) {
    double *first = malloc((2 * bed->n + 1) * sizeof *first);
    uint64_t least = UINT64_MAX, clump = 0;
    int status = fibrad_agree(r->comm, first ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    for (size_t i = 0; i < bed->n && !status; ++i) first[2 * i] = value[i], first[2 * i + 1] = 0;
    if (!status) status = fibrad_clump_sums(r->comm, bed->clump, bed->id, bed->n, first, 2);
    for (size_t i = 0; i < bed->n && !status; ++i)
        if (first[2 * i] != value[i] && bed->id[i] < least) least = bed->id[i], clump = bed->clump[i];
    free(first);
    if (status) return refuse(r, "out of memory");
    const uint64_t own = least;
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_UINT64_T, MPI_MIN, r->comm);
    if (own != least) clump = 0;
    MPI_Allreduce(MPI_IN_PLACE, &clump, 1, MPI_UINT64_T, MPI_MAX, r->comm);
    if (least == UINT64_MAX) return true;
    return refuse(r, "particle %" PRIu64 ": the members of its clump %" PRIu64 " have different %s", least, clump,
                  values);
}

static double area_of(const struct radiation *r, const fibrad_insitu_bed *bed, size_t i) {
    return bed->clump ? r->area[i] : 4 * acos(-1) * bed->radius[i] * bed->radius[i];
}

/* Finds the exposed areas of the particles of the last powers. */
static int find_areas(struct radiation *r, const fibrad_insitu_bed *bed) {
    double *area = realloc(r->area, (bed->n + 1) * sizeof *area);
    if (area) r->area = area;
    const int status = fibrad_agree(r->comm, area ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    for (size_t i = 0; i < bed->n && !status; ++i) area[i] = 4 * acos(-1) * bed->radius[i] * bed->radius[i];
    return status ? status : fibrad_insitu_exposed(r->insitu, bed->clump, area);
}

bool radiation_powers(struct radiation *r, const fibrad_insitu_bed *bed, const double *temperature, uint64_t step,
                      const double *solid, const double *capacity, double seconds, double *power, double *conductance) {
    fibrad_insitu_state state = {
        .sigma = r->sigma, .surroundings = r->surroundings, .wall_temperature = r->temperature};
    state.n = bed->n, state.id = bed->id, state.temperature = temperature;
    int status = fibrad_insitu_powers(r->insitu, &state, power, &r->totals);
    if (status == FIBRAD_E_STATE) { /* particles have come or gone since the rows were made */
        if (!radiation_rows(r, bed, step, true)) return false;
        status = fibrad_insitu_powers(r->insitu, &state, power, &r->totals);
    }
    r->powers_found++;
    if (!status && bed->clump) status = find_areas(r, bed);
    for (size_t i = 0; i < bed->n; ++i) conductance[i] = 0;
    if (!take(r, status, step) || !r->conducts) return !status;
    double *through = malloc((bed->n + 1) * sizeof *through);
    status = fibrad_agree(r->comm, through ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    r->spots.conductivity = solid, r->spots.capacity = capacity, r->spots.seconds = seconds;
    if (!status) status = fibrad_insitu_conduct(r->insitu, &r->spots, bed, &state, through, conductance, &r->conducted);
    for (size_t i = 0; i < bed->n && !status; ++i) power[i] += through[i];
    free(through);
    if (!status && r->conducted.parts > 1 && !r->told_parts) {
        refuse(r, "step %" PRIu64 ": contacts conduct in %g parts of a step of heat", step, r->conducted.parts);
        r->say(r->simulation, r->fault, false);
        r->told_parts = true;
    }
    return take(r, status, step);
}

/* ---- steps of heat ---------------------------------------------------------------------------------------------- */

/* Refuses steps that are `ratio` times as long as the longest stable ones. */
static bool judge(struct radiation *r, const char *what, double ratio, double seconds, long every) {
    if (!(ratio >= 1)) return true;
    const long most = (long)((double)every / ratio * (1 - 1e-9));
    return most ? refuse(r, "steps of heat are too long for %s: they must be at most %ld time steps long", what, most)
                : refuse(r, "steps of heat are too long for %s: the time step must be at most %.3g", what,
                         seconds / ratio);
}

bool radiation_stable(struct radiation *r, const fibrad_insitu_bed *bed, const double *temperature,
                      const double *capacity, const double *conductance, double seconds, long every) {
    struct {
        double ratio;
        int rank;
    } worst = {0};
    uint64_t id = 0;
    char what[MESH_NAME + 16];
    MPI_Comm_rank(r->comm, &worst.rank);
    double(*sum)[3] = malloc((bed->n + 1) * sizeof *sum); /* unused, gain, capacity */
    int status = fibrad_agree(r->comm, sum ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    for (size_t i = 0; i < bed->n && !status; ++i) {
        const double t = temperature[i], area = area_of(r, bed, i);
        const double gain = 4 * r->sigma * t * t * t * area * bed->emissivity[i] + 2 * conductance[i];
        sum[i][0] = 0, sum[i][1] = gain, sum[i][2] = capacity[i];
    }
    if (!status && bed->clump) status = fibrad_clump_sums(r->comm, bed->clump, bed->id, bed->n, *sum, 3);
    for (size_t i = 0; i < bed->n && !status; ++i) {
        const double ratio = sum[i][1] * seconds / sum[i][2];
        if (ratio > worst.ratio) worst.ratio = ratio, id = bed->id[i];
    }
    free(sum);
    if (status) return refuse(r, "out of memory");
    MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, r->comm);
    MPI_Bcast(&id, 1, MPI_UINT64_T, worst.rank, r->comm);
    snprintf(what, sizeof what, "particle %" PRIu64, id);
    if (!judge(r, what, worst.ratio, seconds, every)) return false;
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(r->insitu, &facts);
    for (uint32_t k = 0; k < r->walls; ++k) {
        const double t = r->temperature[k];
        const double gain = 4 * r->sigma * t * t * t * facts.wall[k] + 2 * r->conducted.conductance[k];
        snprintf(what, sizeof what, "wall %.31s", r->name[k]);
        if (r->words[k]->capacity > 0 && !judge(r, what, gain * seconds / r->words[k]->capacity, seconds, every))
            return false;
    }
    return true;
}

bool radiation_convect(struct radiation *r, const fibrad_insitu_bed *bed, const double *temperature,
                       const double *coefficient, const double *gas, double *power, double *conductance) {
    double fault[3] = {0}, sums[2] = {0}; /* id, coefficient and gas of the particle at fault; its id, and the power */
    for (size_t i = 0; i < bed->n; ++i) {
        const double film = coefficient[i] * area_of(r, bed, i);
        const double gain = film * (gas[i] - temperature[i]);
        const bool good =
            film >= 0 && film <= FIBRAD_CONDUCTANCE_MAX && gas[i] >= 0 && gas[i] <= FIBRAD_TEMPERATURE_MAX;
        if (!good && !((double)bed->id[i] < fault[0]))
            fault[0] = (double)bed->id[i], fault[1] = coefficient[i], fault[2] = gas[i];
        power[i] += gain, conductance[i] += film / 2;
        sums[1] += gain;
    }
    sums[0] = fault[0];
    MPI_Allreduce(MPI_IN_PLACE, &sums[1], 1, MPI_DOUBLE, MPI_SUM, r->comm);
    r->convected = sums[1];
    MPI_Allreduce(MPI_IN_PLACE, sums, 1, MPI_DOUBLE, MPI_MAX, r->comm);
    if (sums[0] == 0) return true;
    for (int k = 0; k < 3; ++k)
        if (fault[0] != sums[0]) fault[k] = -INFINITY;
    MPI_Allreduce(MPI_IN_PLACE, fault, 3, MPI_DOUBLE, MPI_MAX, r->comm);
    return refuse(r, "particle %.0f: convection %g to gas of %g K; both must be 0 or more", sums[0], fault[1],
                  fault[2]);
}

void radiation_heat_walls(struct radiation *r, double seconds) {
    for (uint32_t k = 0; k < r->walls; ++k)
        if (r->words[k]->capacity > 0)
            r->temperature[k] += (r->totals.wall[k] + r->conducted.wall[k]) * seconds / r->words[k]->capacity;
}

void radiation_free(struct radiation *r) {
    fibrad_insitu_free(r->insitu);
    free(r->area);
    mesh_walls_free(&r->meshes);
    curve_free(&r->gas);
}
