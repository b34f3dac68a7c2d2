/* precice.c - preCICE as the partner: its library is loaded when a run asks for it. SPDX-License-Identifier: MIT
 *
 * The configuration says which meshes the participant provides, and which data it reads and writes there. Ends of
 * names, behind - or _, say what they are. A mesh ends in the name of a wall, or in Particles or Spheres. Ends of data
 * are in `kinds`. Source: preCICE 3, preciceC.h. */
#include <dlfcn.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "partner/partner.h"
#include "text/xml.h"

enum { NAME = 128, ITEMS = 64, PARTICLES = WALLS_MAX };

/* Functions of libprecice, in the order of their names below. */
struct library {
    void (*initialize)(void);
    void (*create)(const char *participant, const char *file, int rank, int ranks);
    const char *(*version)(void);
    void (*advance)(double length);
    void (*vertices)(const char *mesh, int n, const double *at, int *id);
    int (*wants_initial)(void);
    void (*finalize)(void);
    int (*ongoing)(void);
    int (*wants_saving)(void);
    void (*read)(const char *mesh, const char *data, int n, const int *id, double time, double *value);
    int (*dimensions)(const char *mesh);
    int (*wants_return)(void);
    void (*write)(const char *mesh, const char *data, int n, const int *id, const double *value);
    double (*longest)(void);
};
static const char *const symbols[] = {"initialize", "createParticipant", "getVersionInformation",
                                      "advance",    "setMeshVertices",   "requiresInitialData",
                                      "finalize",   "isCouplingOngoing", "requiresWritingCheckpoint",
                                      "readData",   "getMeshDimensions", "requiresReadingCheckpoint",
                                      "writeData",  "getMaxTimeStepSize"};
enum { SYMBOLS = sizeof symbols / sizeof *symbols };

enum { KIND_TEMPERATURE, KIND_SINK, KIND_FILM, KIND_POWER, KIND_FLUX, KIND_CONDUCTANCE, KIND_SOURCE, KINDS };
static const char *const kinds[KINDS] = {
    "Temperature", "Sink-Temperature", "Heat-Transfer-Coefficient", "Power", "Heat-Flux", "Conductance", "Source"};

/* Data of a mesh of the participant. If `data` is empty: the mesh itself. */
struct item {
    char mesh[NAME], data[NAME];
    bool written;
    int kind;
    uint32_t wall; /* PARTICLES: the spheres */
};

struct precice {
    struct item item[ITEMS];
    size_t items;
    struct library library;
    int *id;       /* [faces, then particles] of vertices */
    double *value; /* [the same] */
    bool created;
};

/* ---- the configuration ------------------------------------------------------------------------------------------- */

/* Whether a name is a word, or ends in - or _ and the word. */
static bool ends_in(const char *name, const char *word) {
    const size_t n = strlen(name), w = strlen(word);
    return n >= w && strcmp(name + n - w, word) == 0 && (n == w || strchr("-_", name[n - w - 1]));
}

static bool is_of_particles(const char *mesh) { return ends_in(mesh, "Particles") || ends_in(mesh, "Spheres"); }

/* The kind of data by the end of its name. KINDS: none. The longest end counts. */
static int kind_of(const char *data) {
    int found = KINDS;
    for (int k = 0; k < KINDS; ++k)
        if (ends_in(data, kinds[k]) && (found == KINDS || strlen(kinds[k]) > strlen(kinds[found]))) found = k;
    return found;
}

static int add_item(struct exchange *e, const struct xml_tag *tag, const char *mesh_key) {
    struct precice *p = e->state;
    struct item item = {.written = xml_is(tag, "write-data")};
    char value[XML_WORD];
    snprintf(item.mesh, NAME, "%.*s", NAME - 1, xml_attribute(tag, mesh_key, value));
    if (strcmp(mesh_key, "mesh") == 0) snprintf(item.data, NAME, "%.*s", NAME - 1, xml_attribute(tag, "name", value));
    item.kind = kind_of(item.data);
    const bool particles = is_of_particles(item.mesh);
    static const unsigned allowed[2][2] = {
        {1 << KIND_TEMPERATURE | 1 << KIND_FILM | 1 << KIND_SINK,
         1 << KIND_POWER | 1 << KIND_FLUX | 1 << KIND_TEMPERATURE},
        {1 << KIND_TEMPERATURE | 1 << KIND_FILM,
         1 << KIND_POWER | 1 << KIND_CONDUCTANCE | 1 << KIND_SOURCE | 1 << KIND_TEMPERATURE}};
    if (item.data[0] && !(allowed[particles][item.written] >> item.kind & 1))
        return message_at(
            STATUS_USAGE, e->file, 0, "%s %s %s; %s", item.mesh, item.written ? "writes" : "reads", item.data,
            particles ? "particles read Temperature and Heat-Transfer-Coefficient, and write Power, Source, "
                        "Conductance or Temperature"
                      : "faces read Temperature, or Heat-Transfer-Coefficient and Sink-Temperature, and "
                        "write Power, Heat-Flux or Temperature");
    if (p->items == ITEMS)
        return message_at(STATUS_USAGE, e->file, 0, "the participant %s has more than %d meshes and data",
                          e->participant, ITEMS);
    if (particles && !item.written && item.data[0]) {
        e->gives_gas = e->gives_gas || item.kind == KIND_TEMPERATURE;
        e->gives_film = e->gives_film || item.kind == KIND_FILM;
    }
    e->takes_power = e->takes_power || (particles && item.written && item.kind != KIND_TEMPERATURE);
    p->item[p->items++] = item;
    return STATUS_OK;
}

/* Takes the meshes and data of the participant. */
static int take_config(struct exchange *e, const char *text, size_t size) {
    const struct precice *p = e->state;
    const char *at = text, *end = text + size;
    struct xml_tag tag;
    char value[XML_WORD], others[NAME] = "";
    bool within = false, found = false;
    while (xml_next(&at, end, &tag)) {
        int status = STATUS_OK;
        if (xml_is(&tag, "participant") && *xml_attribute(&tag, "name", value) && tag.end[-1] != '/') {
            within = strcmp(value, e->participant) == 0, found = found || within;
            const size_t length = strlen(others);
            snprintf(others + length, NAME - length, "%s%.40s", length ? ", " : "", value);
        } else if (xml_is(&tag, "/participant")) {
            within = false;
        } else if (within && xml_is(&tag, "provide-mesh")) {
            status = add_item(e, &tag, "name");
        } else if (within && (xml_is(&tag, "read-data") || xml_is(&tag, "write-data"))) {
            status = add_item(e, &tag, "mesh");
        }
        if (status) return status;
    }
    if (!found)
        return message_at(STATUS_USAGE, e->file, 0, "there is no participant %s; there %s %s", e->participant,
                          others[0] ? "are" : "is", others[0] ? others : "none");
    return p->items > 0 ? STATUS_OK
                        : message_at(STATUS_USAGE, e->file, 0, "the participant %s provides no mesh", e->participant);
}

static int precice_plan(struct exchange *e) {
    struct lines lines;
    char *text = NULL;
    size_t size = 0;
    e->name = "preCICE";
    if (!e->participant) return message(STATUS_USAGE, "--precice needs --participant NAME");
    e->state = calloc(1, sizeof(struct precice));
    if (!e->state) return message_memory();
    int status = lines_open(&lines, e->file);
    if (!status) status = lines_rest(&lines, &text, &size);
    if (!status) status = take_config(e, text, size);
    lines_close(&lines);
    return status;
}

/* Whether the participant reads a kind of data of a mesh. */
static bool reads(const struct precice *p, const char *mesh, int kind) {
    bool found = false;
    for (size_t k = 0; k < p->items; ++k)
        found = found || (!p->item[k].written && p->item[k].kind == kind && strcmp(p->item[k].mesh, mesh) == 0);
    return found;
}

static int precice_choose(struct exchange *e) {
    struct precice *p = e->state;
    for (struct item *item = p->item; item < p->item + p->items; ++item) {
        item->wall = PARTICLES;
        for (uint32_t k = 0; k < e->walls->count && !is_of_particles(item->mesh); ++k)
            if (e->walls->wall[k].kind == FIBRAD_WALL_MESH && ends_in(item->mesh, wall_name(e->walls, k)))
                item->wall = k;
        if (item->wall != PARTICLES)
            e->exchanged[item->wall] = true;
        else if (!is_of_particles(item->mesh))
            return message_at(
                STATUS_USAGE, e->file, 0,
                "the name of the mesh %s ends neither in the name of a wall of triangles nor in Particles", item->mesh);
        if (item->wall != PARTICLES && reads(p, item->mesh, KIND_FILM) != reads(p, item->mesh, KIND_SINK))
            return message_at(STATUS_USAGE, e->file, 0,
                              "the mesh %s reads only one of Heat-Transfer-Coefficient and Sink-Temperature",
                              item->mesh);
    }
    return STATUS_OK;
}

/* ---- calls: preCICE aborts the program after an error ------------------------------------------------------------ */

static sigjmp_buf stopped;

static struct sigaction before_alarm;

/* Leaves a call. After an interrupt the alarm, two seconds later, ends the program by the handler that was there. */
static void leave_call(int signal) {
    if (signal == SIGALRM && interrupt_status()) before_alarm.sa_handler(signal);
    siglongjmp(stopped, signal);
}

/* Sends standard output to the file `to`. Returns a copy of the file to which it went before. */
static int redirect_output(int to) {
    fflush(stdout);
    const int before = dup(STDOUT_FILENO);
    dup2(to, STDOUT_FILENO);
    return before;
}

/* Calls a function of this file that calls preCICE. After an error preCICE prints it and aborts. Then this function
 * prints that preCICE has ended. If preCICE does not return within exchange->timeout, the run ends, too. The log of
 * preCICE goes to standard error. */
static int guarded(struct exchange *e, int (*call)(struct exchange *)) {
    struct sigaction leave = {.sa_handler = leave_call}, before_abort;
    const int output = redirect_output(STDERR_FILENO);
    sigemptyset(&leave.sa_mask);
    sigaction(SIGABRT, &leave, &before_abort);
    sigaction(SIGALRM, &leave, &before_alarm);
    const int signal = sigsetjmp(stopped, 1);
    int status = STATUS_OK;
    if (signal == 0) {
        alarm(e->timeout > 0 ? (unsigned)fmin(e->timeout + 1, INT32_MAX) : 0);
        status = call(e);
    }
    alarm(0);
    sigaction(SIGABRT, &before_abort, NULL);
    sigaction(SIGALRM, &before_alarm, NULL);
    close(redirect_output(output));
    close(output);
    if (interrupt_status()) return interrupt_status();
    if (signal == SIGABRT) status = message(STATUS_FILE, "preCICE has ended with an error, which it has printed");
    if (signal == SIGALRM) status = message(STATUS_FILE, "no word from preCICE in %g s (--timeout)", e->timeout);
    return status;
}

/* The first vertex of an item, and their number n. All faces come before the particles. */
static uint32_t first_of(const struct exchange *e, const struct item *item, uint32_t *n) {
    const struct exchange_faces *f = &e->faces;
    *n = item->wall == PARTICLES ? e->particles.n : f->first[item->wall + 1] - f->first[item->wall];
    return item->wall == PARTICLES ? f->n : f->first[item->wall];
}

static void write_item(struct exchange *e, const struct item *item) {
    struct precice *p = e->state;
    const bool faces = item->wall != PARTICLES;
    uint32_t n;
    const uint32_t first = first_of(e, item, &n), from = faces ? first : 0;
    const double *energy = faces ? e->faces.energy : e->particles.energy,
                 *found = faces ? e->faces.found : e->particles.found;
    for (uint32_t k = 0; k < n; ++k) {
        const double power = e->length > 0 ? energy[from + k] / e->length : 0;
        p->value[k] = item->kind == KIND_TEMPERATURE   ? found[from + k]
                      : item->kind == KIND_FLUX        ? power / e->faces.area[from + k]
                      : item->kind == KIND_CONDUCTANCE ? e->particles.conductance[k]
                      : item->kind == KIND_SOURCE      ? power + e->particles.conductance[k] * e->particles.gas[k]
                                                       : power;
    }
    p->library.write(item->mesh, item->data, (int)n, p->id + first, p->value);
}

static void write_items(struct exchange *e) {
    const struct precice *p = e->state;
    for (size_t k = 0; k < p->items; ++k)
        if (p->item[k].written) write_item(e, &p->item[k]);
}

static int read_item(struct exchange *e, const struct item *item) {
    struct precice *p = e->state;
    uint32_t n;
    const uint32_t first = first_of(e, item, &n);
    double *const of_faces[] = {e->faces.temperature, e->faces.behind, e->faces.film};
    double *const of_particles[] = {e->particles.gas, NULL, e->particles.film};
    double *to = item->wall == PARTICLES ? of_particles[item->kind] : of_faces[item->kind] + first;
    p->library.read(item->mesh, item->data, (int)n, p->id + first, e->length, to);
    for (uint32_t k = 0; k < n; ++k)
        if (item->kind == KIND_FILM ? !(to[k] >= 0 && to[k] < INFINITY) : !(to[k] > 0 && to[k] <= TEMPERATURE_MAX))
            return message(STATUS_INPUT, "preCICE gives %s of %s as %g at vertex %u; %s is expected", item->data,
                           item->mesh, to[k], k, item->kind == KIND_FILM ? "0 or more" : "a temperature above 0 K");
    return STATUS_OK;
}

static int connect_now(struct exchange *e) {
    struct precice *p = e->state;
    p->created = true;
    p->library.create(e->participant, e->file, 0, 1);
    for (const struct item *item = p->item; item < p->item + p->items; ++item) {
        uint32_t n;
        const uint32_t first = first_of(e, item, &n);
        if (item->data[0]) continue;
        if (p->library.dimensions(item->mesh) != 3)
            return message_at(STATUS_USAGE, e->file, 0, "the mesh %s must have 3 dimensions", item->mesh);
        p->library.vertices(item->mesh, (int)n,
                            item->wall == PARTICLES ? e->particles.centre[0] : e->faces.centre[first], p->id + first);
    }
    if (p->library.wants_initial()) write_items(e);
    p->library.initialize();
    return STATUS_OK;
}

static int read_now(struct exchange *e) {
    const struct precice *p = e->state;
    int status = STATUS_OK;
    e->length = 0;
    if (!p->library.ongoing()) return STATUS_OK;
    (void)p->library.wants_saving(); /* asked at each window; the bed saves its state anyway */
    e->length = p->library.longest();
    for (size_t k = 0; k < p->items && !status; ++k)
        if (p->item[k].data[0] && !p->item[k].written) status = read_item(e, &p->item[k]);
    return status;
}

static int write_now(struct exchange *e) {
    const struct precice *p = e->state;
    write_items(e);
    p->library.advance(e->length);
    return STATUS_OK;
}

static int finish_now(struct exchange *e) {
    const struct precice *p = e->state;
    p->library.finalize();
    return STATUS_OK;
}

/* Loads libprecice. */
static int load_library(struct precice *p) {
    void *function[SYMBOLS];
    void *const handle = dlopen("libprecice.so.3", RTLD_NOW | RTLD_GLOBAL);
    if (!handle)
        return message(STATUS_FILE, "--precice: libprecice.so.3 cannot be loaded: %s; LD_LIBRARY_PATH says where it is",
                       dlerror());
    for (size_t k = 0; k < SYMBOLS; ++k) {
        char name[64];
        snprintf(name, sizeof name, "precicec_%s", symbols[k]);
        function[k] = dlsym(handle, name);
        if (!function[k]) return message(STATUS_FILE, "--precice: libprecice.so.3 has no %s", name);
    }
    memcpy(&p->library, function, sizeof function);
    const char *version = p->library.version();
    if (strncmp(version, "3.", 2) == 0) return STATUS_OK;
    return message(STATUS_FILE, "--precice: this is preCICE %.*s; version 3 is needed", (int)strcspn(version, ";"),
                   version);
}

static int precice_begin(struct exchange *e) {
    struct precice *p = e->state;
    const size_t n = (size_t)e->faces.n + e->particles.n + 1;
    p->id = calloc(n, sizeof *p->id), p->value = calloc(n, sizeof *p->value);
    if (!p->id || !p->value) return message_memory();
    const int status = load_library(p);
    return status ? status : guarded(e, connect_now);
}

static int precice_next(struct exchange *e) { return guarded(e, read_now); }

static int precice_give(struct exchange *e, bool *again) {
    const struct precice *p = e->state;
    const int status = guarded(e, write_now);
    *again = !status && p->library.wants_return();
    return status;
}

/* After an error the destructors of preCICE would fail at the end of the program: _exit leaves them out. Partners see
 * that their connections end. */
static int precice_end(struct exchange *e, int status) {
    struct precice *p = e->state;
    if (!p) return status;
    if (p->created && !status) status = guarded(e, finish_now);
    if (p->created && status) {
        fflush(stdout);
        _exit(status);
    }
    free(p->id);
    free(p->value);
    free(p);
    e->state = NULL;
    return status;
}

const struct partner partner_precice = {precice_plan, precice_choose, precice_begin,
                                        precice_next, precice_give,   precice_end};
