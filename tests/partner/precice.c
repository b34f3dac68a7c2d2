/* precice.c - stands in for libprecice: the functions that `fibrad couple` calls, and the other solver behind them.
 * SPDX-License-Identifier: MIT
 *
 * At each vertex of a mesh the other solver conducts LEAK [W/K] to AROUND. Where the bed writes Power and reads
 * Temperature, it gives T = AROUND + power/LEAK: a wall for faces, a stirred gas for particles. Data that end in
 * Sink-Temperature are AROUND, those that end in Coefficient are FILM [W/(m2 K)]. What it has received is appended to
 * the file RECEIVED, a line a time window: energies [J] of meshes in the order in which they were set.
 *
 * Environment, beside these: WINDOWS, LENGTH [s], IMPLICIT (1: time windows are repeated until temperatures settle),
 * FAULT (what goes wrong, in time window 1: die, zero), VERSION. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MESHES = 4, VERTICES = 20000 };
#define SETTLED 1e-8 /* [K] */
#define RELAXED .85  /* share of the change of a repeat that is taken */

static struct mesh {
    char name[80];
    int n, by_films;
    double temperature[VERTICES], power[VERTICES];
} mesh[MESHES];
static int meshes, window, repeats, again, open;

static const char *said(const char *name, const char *otherwise) { return getenv(name) ? getenv(name) : otherwise; }
static double number(const char *name, const char *otherwise) { return strtod(said(name, otherwise), NULL); }
static int ends(const char *name, const char *end) {
    return strlen(name) >= strlen(end) && strcmp(name + strlen(name) - strlen(end), end) == 0;
}

static struct mesh *named(const char *name) {
    int k = 0;
    while (k < meshes && strcmp(mesh[k].name, name) != 0) ++k;
    if (k == meshes) abort();
    return &mesh[k];
}

const char *precicec_getVersionInformation(void) { return said("VERSION", "3.9.9;no revision"); }
void precicec_createParticipant(const char *participant, const char *file, int rank, int ranks) {
    if (!*participant || !*file || rank != 0 || ranks != 1) abort();
    open = 1;
}
int precicec_getMeshDimensions(const char *name) { return strstr(name, "Flat") ? 2 : 3; }

void precicec_setMeshVertices(const char *name, int n, const double *at, int *id) {
    struct mesh *m = &mesh[meshes++];
    if (n > VERTICES || !(at[0] == at[0])) abort();
    snprintf(m->name, sizeof m->name, "%s", name);
    m->n = n;
    for (int k = 0; k < n; ++k) id[k] = k, m->temperature[k] = number("AROUND", "300");
}

int precicec_requiresInitialData(void) { return 1; }
void precicec_initialize(void) {}
void precicec_finalize(void) { open = 0; }
/* The true library would wait for the other solver. */
__attribute__((destructor)) static void finalize_late(void) {
    if (open) abort();
}
int precicec_isCouplingOngoing(void) { return window < number("WINDOWS", "3"); }
int precicec_requiresWritingCheckpoint(void) { return number("IMPLICIT", "0") > 0; }
int precicec_requiresReadingCheckpoint(void) { return again; }
double precicec_getMaxTimeStepSize(void) { return number("LENGTH", "100"); }

void precicec_readData(const char *name, const char *data, int n, const int *id, double time, double *value) {
    struct mesh *m = named(name);
    if (ends(data, "Coefficient")) m->by_films = 1;
    if (time != precicec_getMaxTimeStepSize() || n != m->n) abort();
    for (int k = 0; k < n; ++k)
        value[k] = ends(data, "Coefficient")        ? number("FILM", "10")
                   : ends(data, "Sink-Temperature") ? number("AROUND", "300")
                                                    : m->temperature[id[k]];
    if (window == 1 && strcmp(said("FAULT", ""), "zero") == 0) value[n / 2] = 0;
}

void precicec_writeData(const char *name, const char *data, int n, const int *id, const double *value) {
    struct mesh *m = named(name);
    if (n != m->n) abort();
    for (int k = 0; k < n && ends(data, "Power"); ++k) m->power[id[k]] = value[k];
}

static void note_received(double length) {
    FILE *file = fopen(said("RECEIVED", "/dev/null"), "a");
    for (int k = 0; k < meshes; ++k) {
        double sum = 0;
        for (int v = 0; v < mesh[k].n; ++v) sum += mesh[k].power[v] * length;
        fprintf(file, "%.15g%c", sum, k == meshes - 1 ? '\n' : ' ');
    }
    fprintf(file, "%.15g %.15g\n", mesh[0].temperature[0], mesh[0].power[0]);
    fclose(file);
}

void precicec_advance(double length) {
    double most = 0;
    if (window == 1 && strcmp(said("FAULT", ""), "die") == 0) abort();
    for (int k = 0; k < meshes; ++k)
        for (int v = 0; v < mesh[k].n; ++v) {
            const double t = number("AROUND", "300") + mesh[k].power[v] / number("LEAK", "1");
            const double part = mesh[k].by_films || number("IMPLICIT", "0") == 0 ? 0 : RELAXED;
            const double change = part * (t - mesh[k].temperature[v]);
            mesh[k].temperature[v] += change, most = fmax(most, fabs(change));
        }
    again = most > SETTLED && ++repeats < 400;
    if (again) return;
    note_received(length);
    repeats = 0, ++window;
}
