/* openfoam.c - the partner OpenFOAM, by the files of its function object externalCoupled. SPDX-License-Identifier: MIT
 *
 * OpenFOAM and the bed take turns. OpenFOAM.lock in the folder of the files says whose turn it is:
 *
 *     OpenFOAM.lock      T.out      turn
 *     there              any        OpenFOAM's: it goes through a time window, writes T.out and removes the lock
 *     not there          there      ours: we write T.in, then the lock
 *     not there          not yet    ours: with initByExternal OpenFOAM waits for a first T.in
 *     "done", or gone    gone       nobody's: OpenFOAM has ended
 *
 * GROUP/ or REGION/GROUP/ in that folder has the other files. patchPoints and patchFaces have the points and the
 * corners of faces, patch by patch. T.out has a row `area Twall qDot htc` a face [m2, K, W/m2, W/(m2 K)]: qDot goes
 * into the fluid, and htc is qDot over the difference to the temperature of the cell at the face. T.in has rows `value
 * gradient fraction`. With `action=writeNow` in the lock OpenFOAM makes one more step and gives us one more turn, then
 * it ends.
 *
 * Source: OpenFOAM v1912, documentation of externalCoupled and externalCoupledTemperature, and what they do. */
#include <errno.h>
#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "partner/partner.h"
#include "text/read_number.h"

#define AREA_TOLERANCE 0.02     /* of areas that should be the same */
#define FIRST_FILM     10       /* [W/(m2 K)] in a first time window in which no face has a film */
#define TIMEOUT_OF_END 60       /* [s] after an error */
#define LONGEST_PAUSE  50000000 /* [ns] between two looks at the lock */

#define GO_ON "status=openfoam\n"

enum { PATHS = 4, CORNERS_MOST = 64, NO_FACE = -1 };

struct patch_face {
    double centre[3], area, size; /* [m] mean of the corners; [m2]; [m] the largest distance of a corner from it */
    double ours;                  /* [m2] area of our triangles at this face */
    double film, behind;          /* [W/(m2 K)] the last one, 0: there was none yet; [K] */
    double found;                 /* [K] mean over our triangles; 0: not known yet */
};

struct openfoam {
    char folder[OUTPUT_PATH / 4], group[OUTPUT_PATH / 2]; /* group "": not found yet */
    int n;
    struct patch_face *face; /* [n] in the order of rows */
    int *at;                 /* [exchange->faces.n] the face of each triangle */
    bool begun;              /* there was a T.out */
    bool silent;             /* OpenFOAM has not answered in time */
};

/* The path of a file, until PATHS others have been made. */
static const char *foam_file(const char *folder, const char *name) {
    static char paths[PATHS][OUTPUT_PATH];
    static unsigned next;
    char *path = paths[next++ % PATHS];
    snprintf(path, OUTPUT_PATH, "%s/%s", folder, name);
    return path;
}

/* ---- turns ------------------------------------------------------------------------------------------------------- */

enum turn { THEIRS, OURS, FIRST, NOBODYS };

/* Finds the folder with patchFaces. */
static int find_group(struct openfoam *foam) {
    glob_t found = {0};
    glob(foam_file(foam->folder, "*/patchFaces"), 0, NULL, &found);
    glob(foam_file(foam->folder, "*/*/patchFaces"), found.gl_pathv ? GLOB_APPEND : 0, NULL, &found);
    int status = STATUS_OK;
    if (found.gl_pathc > 1)
        status = message(STATUS_INPUT, "%s and %s: put all patches beside the bed into one group", found.gl_pathv[0],
                         found.gl_pathv[1]);
    else if (found.gl_pathc == 1)
        snprintf(foam->group, sizeof foam->group, "%.*s", (int)(strrchr(found.gl_pathv[0], '/') - found.gl_pathv[0]),
                 found.gl_pathv[0]);
    globfree(&found);
    return status;
}

static int look_at_lock(struct openfoam *foam, enum turn *turn) {
    *turn = THEIRS;
    const int status = *foam->group ? STATUS_OK : find_group(foam);
    if (status || !*foam->group) return status;
    struct stat faces;
    char text[64] = "";
    const char *path = foam_file(foam->folder, "OpenFOAM.lock");
    FILE *lock = fopen(path, "r");
    if (!lock && errno != ENOENT) return message_at(STATUS_FILE, path, 0, "%s", strerror(errno));
    if (lock) {
        if (fgets(text, sizeof text, lock) && strstr(text, "done") && foam->begun) *turn = NOBODYS;
        fclose(lock);
    } else if (access(foam_file(foam->group, "T.out"), F_OK) == 0)
        *turn = OURS;
    else if (foam->begun)
        *turn = NOBODYS;
    else if (stat(foam_file(foam->group, "patchFaces"), &faces) == 0 && time(NULL) > faces.st_mtime + 1)
        *turn = FIRST; /* patchFaces is a second old, and thus complete */
    foam->begun = foam->begun || *turn == OURS;
    return STATUS_OK;
}

/* Waits until it is not OpenFOAM's turn. */
static int wait_for_turn(const struct exchange *exchange, enum turn *turn) {
    struct openfoam *foam = exchange->state;
    struct timespec pause = {.tv_nsec = 1000000};
    double waited = 0;
    int status;
    while (!(status = look_at_lock(foam, turn)) && *turn == THEIRS && !(status = interrupt_status())) {
        foam->silent = waited > exchange->timeout;
        if (foam->silent)
            return message(STATUS_FILE, "%s: OpenFOAM has not answered for %g s; is it running?", foam->folder,
                           exchange->timeout);
        nanosleep(&pause, NULL);
        waited += 1e-9 * (double)pause.tv_nsec;
        if (pause.tv_nsec < LONGEST_PAUSE) pause.tv_nsec += pause.tv_nsec / 4;
    }
    return status;
}

/* ---- numbers of OpenFOAM's files --------------------------------------------------------------------------------- */

struct numbers {
    struct lines lines;
    struct fields fields;
    size_t next;
    bool fluid; /* a comment says that temperatures are those of the fluid */
};

static void numbers_close(struct numbers *from) {
    lines_close(&from->lines);
    free(from->fields.at);
}

/* Reads the next number. Skips brackets and comments. more NULL: there must be one. */
static int next_number(struct numbers *from, double *value, bool *more) {
    struct lines *lines = &from->lines;
    bool is_line = true;
    while (from->next == from->fields.n) {
        int status = lines_next_text(lines, &is_line);
        if (more) *more = is_line;
        if (status || (!is_line && more)) return status;
        if (!is_line) return lines_fault(lines, "the file ends too early");
        from->next = from->fields.n = 0;
        if (lines_comment(lines))
            from->fluid = from->fluid || strstr(lines->text, "Tfluid");
        else if (!lines_begin(lines, "//") && (status = fields_split(&from->fields, lines->text, "() \t")))
            return status;
    }
    const char *text = from->fields.at[from->next++];
    return number_read(text, value) ? STATUS_OK : lines_fault(lines, "'%.40s' is no number", text);
}

/* Reads a whole number from 0 to below `end`. */
static int next_whole(struct numbers *from, int end, int *value, bool *more) {
    double number = 0;
    const int status = next_number(from, &number, more);
    if (!status && !(number >= 0 && number < end && number == floor(number)))
        return lines_fault(&from->lines, "a whole number from 0 to %d is expected", end - 1);
    *value = (int)number;
    return status;
}

/* ---- faces ------------------------------------------------------------------------------------------------------- */

/* Reads the corners of a face among n points. */
static int read_corners(struct numbers *from, double (*point)[3], int n, struct patch_face *face) {
    const double *corner[CORNERS_MOST] = {0};
    double area[3] = {0};
    int corners, index = 0;
    int status = next_whole(from, CORNERS_MOST + 1, &corners, NULL);
    *face = (struct patch_face){0};
    for (int k = 0; !status && k < corners && !(status = next_whole(from, n, &index, NULL)); ++k) {
        corner[k] = point[index];
        for (int c = 0; c < 3; ++c) face->centre[c] += corner[k][c] / corners;
    }
    for (int k = 0; !status && k < corners; ++k) {
        const double *const o = corner[0], *const a = corner[k], *const b = corner[(k + 1) % corners];
        for (int c = 0, d = 1, e = 2; c < 3; d = e, e = c++)
            area[c] += ((a[d] - o[d]) * (b[e] - o[e]) - (a[e] - o[e]) * (b[d] - o[d])) / 2;
        face->size = fmax(face->size, surface_distance(face->centre, a));
    }
    face->area = surface_distance(area, (const double[3]){0});
    return status;
}

/* Reads the points and the faces of each patch. */
static int read_faces(struct openfoam *foam) {
    struct numbers points = {0}, faces = {0};
    double(*point)[3] = NULL;
    bool more = true, good = true;
    int n, of_patch = 0;
    int status = lines_open(&points.lines, foam_file(foam->group, "patchPoints"));
    if (!status) status = lines_open(&faces.lines, foam_file(foam->group, "patchFaces"));
    while (!status && !(status = next_whole(&points, INT32_MAX, &n, &more)) && more) {
        point = memory_resized(point, (size_t)n * sizeof *point, &good);
        for (size_t k = 0; good && !status && k < 3 * (size_t)n; ++k)
            status = next_number(&points, &point[k / 3][k % 3], NULL);
        if (!status) status = next_whole(&faces, INT32_MAX, &of_patch, NULL);
        for (int k = 0; good && !status && k < of_patch; ++k) {
            foam->face = memory_grown(foam->face, (size_t)foam->n, sizeof *foam->face, &good);
            if (good) status = read_corners(&faces, point, n, &foam->face[foam->n++]);
        }
        if (!good) status = message_memory();
    }
    numbers_close(&points);
    numbers_close(&faces);
    free(point);
    return status;
}

/* ---- our triangles at these faces -------------------------------------------------------------------------------- */

struct along {
    double at; /* [m] along a direction that is at right angles to few walls */
    int face;
};

static double along_of(const double p[3]) { return 0.36 * p[0] + 0.48 * p[1] + 0.8 * p[2]; }

/* Finds the face with the nearest centre for each triangle, no farther than the size of that face. */
static int find_nearest_faces(const struct exchange_faces *faces, struct openfoam *foam) {
    double largest = 0;
    struct along *sorted = malloc(((size_t)foam->n + 1) * sizeof *sorted);
    foam->at = malloc(((size_t)faces->n + 1) * sizeof *foam->at);
    if (!sorted || !foam->at) return free(sorted), message_memory();
    for (int k = 0; k < foam->n; ++k) {
        sorted[k] = (struct along){along_of(foam->face[k].centre), k};
        largest = fmax(largest, foam->face[k].size);
    }
    qsort(sorted, (size_t)foam->n, sizeof *sorted, number_order);
    for (uint32_t t = 0; t < faces->n; ++t) {
        const double at = along_of(faces->centre[t]);
        double least = largest;
        int low = 0, found = NO_FACE;
        for (int step = 1 << 30; step > 0; step /= 2)
            if (step <= foam->n - low && sorted[low + step - 1].at < at - largest) low += step;
        for (int k = low; k < foam->n && sorted[k].at <= at + least; ++k) {
            const double away = surface_distance(foam->face[sorted[k].face].centre, faces->centre[t]);
            if (away <= least) least = away, found = sorted[k].face;
        }
        foam->at[t] = found != NO_FACE && least <= foam->face[found].size ? found : NO_FACE;
    }
    free(sorted);
    return STATUS_OK;
}

/* Each triangle must be at a face, and each face must have triangles. Their areas must be the same. */
static int match_faces(const struct exchange *exchange, struct openfoam *foam) {
    const struct exchange_faces *faces = &exchange->faces;
    const int status = find_nearest_faces(faces, foam);
    if (status) return status;
    double ours = 0, theirs = 0;
    const double *first = NULL; /* [m] the first centre without a match */
    uint32_t far = 0, bare = 0;
    for (uint32_t t = 0; t < faces->n; ++t) {
        ours += faces->area[t];
        if (foam->at[t] != NO_FACE)
            foam->face[foam->at[t]].ours += faces->area[t];
        else if (far++ == 0)
            first = faces->centre[t];
    }
    for (int k = 0; k < foam->n; ++k) {
        theirs += foam->face[k].area;
        if (!(foam->face[k].ours > 0) && bare++ == 0 && far == 0) first = foam->face[k].centre;
    }
    char why[200] = "";
    const double digits = log10(ours / theirs) / 2; /* units of length differ by 10^2 or more */
    const bool units = fabs(digits) > 1.5 && fabs(digits - round(digits)) < AREA_TOLERANCE / 2;
    if (units || !(far || bare || fabs(ours - theirs) <= AREA_TOLERANCE * theirs))
        snprintf(why, sizeof why, "the faces have %g m2, but the triangles of the bed have %g m2", theirs, ours);
    else if (far)
        snprintf(why, sizeof why, "%u of %u triangles of the bed are at no face, the first at (%g, %g, %g) m", far,
                 faces->n, first[0], first[1], first[2]);
    else if (bare)
        snprintf(why, sizeof why, "%u of %d faces are at no triangle of the bed, the first at (%g, %g, %g) m", bare,
                 foam->n, first[0], first[1], first[2]);
    return *why ? message_at(STATUS_INPUT, foam_file(foam->group, "patchFaces"), 0, "%s%s", why,
                             units ? "; their units of length differ"
                             : far ? "; see --faces"
                                   : "")
                : STATUS_OK;
}

/* ---- rows -------------------------------------------------------------------------------------------------------- */

/* Reads the row of a face. OpenFOAM writes an htc of 0 if wall and cell differ by less than 1e-3 K. Then the film stays
 * the last one, and `behind` is the temperature of the wall. */
static int read_flux(struct numbers *from, struct patch_face *face) {
    double value[4];
    for (int k = 0; k < 4; ++k) {
        const int status = next_number(from, &value[k], NULL);
        if (status) return status;
        if (from->fields.n != 4) return lines_fault(&from->lines, "a row `area Twall qDot htc` is expected");
    }
    const double area = value[0], wall = value[1], flux = value[2], film = value[3];
    const bool good = film > 0 && isfinite(film);
    face->behind = good && !from->fluid ? wall - flux / film : wall;
    if (good) face->film = film;
    if (!(wall > 0 && face->behind > 0 && face->behind < INFINITY))
        return lines_fault(&from->lines, "wall and fluid have %g K and %g K; temperatures above 0 K are expected", wall,
                           face->behind);
    if (!(fabs(area - face->area) <= AREA_TOLERANCE * face->area))
        return lines_fault(&from->lines, "the face has %g m2, but %g m2 in patchFaces, which may be of an earlier run",
                           area, face->area);
    face->area = area;
    return STATUS_OK;
}

static int read_fluxes(struct openfoam *foam) {
    struct numbers from = {0};
    bool more = false;
    double beyond;
    int status = lines_open(&from.lines, foam_file(foam->group, "T.out"));
    for (int k = 0; !status && k < foam->n; ++k) status = read_flux(&from, &foam->face[k]);
    if (!status) status = next_number(&from, &beyond, &more);
    if (!status && more) status = lines_fault(&from.lines, "a row too many; patchFaces has %d faces", foam->n);
    numbers_close(&from);
    return status;
}

/* Finds the temperatures of faces: means over the areas of triangles. Heat through a film is linear in T, so both sides
 * count the same heat. */
static void average_found(const struct exchange *exchange) {
    struct openfoam *foam = exchange->state;
    const struct exchange_faces *faces = &exchange->faces;
    for (int k = 0; k < foam->n; ++k) foam->face[k].found = 0;
    for (uint32_t t = 0; t < faces->n; ++t) {
        struct patch_face *face = &foam->face[foam->at[t]];
        face->found += faces->area[t] / face->ours * faces->found[t];
    }
}

/* Writes T.in, and then the lock. After an error in `begin` faces have no temperature yet: these become insulated. */
static int write_rows(const struct openfoam *foam, const char *text) {
    struct output rows, lock;
    int status = output_open(&rows, foam_file(foam->group, "T.in"));
    if (status) return status;
    for (int k = 0; k < foam->n; ++k) fprintf(rows.file, "%.17g 0 %d\n", foam->face[k].found, foam->face[k].found > 0);
    status = output_close(&rows, STATUS_OK);
    if (!status) status = output_open(&lock, foam_file(foam->folder, "OpenFOAM.lock"));
    if (status) return status;
    fputs(text, lock.file);
    return output_close(&lock, STATUS_OK);
}

/* ---- the partner ------------------------------------------------------------------------------------------------- */

static int openfoam_plan(struct exchange *exchange) {
    exchange->name = "OpenFOAM";
    struct openfoam *foam = exchange->state = calloc(1, sizeof *foam);
    if (!foam) return message_memory();
    const bool is_case = access(foam_file(exchange->folder, "system/controlDict"), F_OK) == 0;
    if (access(exchange->folder, X_OK) != 0) return message_at(STATUS_FILE, exchange->folder, 0, "%s", strerror(errno));
    if (strlen(exchange->folder) > OUTPUT_PATH / 4 - sizeof "/comms")
        return message(STATUS_USAGE, "--openfoam: the path is too long");
    snprintf(foam->folder, sizeof foam->folder, "%s%s", exchange->folder, is_case ? "/comms" : "");
    return STATUS_OK;
}

static int openfoam_begin(struct exchange *exchange) {
    struct openfoam *foam = exchange->state;
    enum turn turn;
    int status = wait_for_turn(exchange, &turn);
    if (!status) status = read_faces(foam);
    if (!status) status = match_faces(exchange, foam);
    if (!status) average_found(exchange);
    return status;
}

static int openfoam_next(struct exchange *exchange) {
    struct openfoam *foam = exchange->state;
    enum turn turn;
    int status;
    while (!(status = wait_for_turn(exchange, &turn)) && turn == FIRST)
        if ((status = write_rows(foam, GO_ON))) return status;
    exchange->length = turn == NOBODYS ? 0 : exchange->window;
    if (!status && turn == OURS) status = read_fluxes(foam);
    if (status || turn == NOBODYS) return status;
    double mean = 0;
    int n = 0;
    for (int k = 0; k < foam->n; ++k)
        if (foam->face[k].film > 0) mean += (foam->face[k].film - mean) / ++n;
    for (uint32_t t = 0; t < exchange->faces.n; ++t) { /* watts are those of OpenFOAM, if areas differ */
        const struct patch_face *face = &foam->face[foam->at[t]];
        const double film = face->film > 0 ? face->film : n > 0 ? mean : FIRST_FILM;
        exchange->faces.film[t] = film * face->area / face->ours;
        exchange->faces.behind[t] = face->behind;
    }
    return STATUS_OK;
}

static int openfoam_give(struct exchange *exchange, bool *again) {
    *again = false;
    average_found(exchange);
    return write_rows(exchange->state, GO_ON);
}

/* Asks OpenFOAM to end if it has not. After an error it may have ended by itself. */
static int openfoam_end(struct exchange *exchange, int status) {
    struct openfoam *foam = exchange->state;
    if (!foam) return status;
    enum turn turn = THEIRS;
    int ending = foam->silent || !*foam->group;
    if (status) exchange->timeout = fmin(exchange->timeout, TIMEOUT_OF_END);
    while (!ending && !(ending = wait_for_turn(exchange, &turn)) && turn != NOBODYS)
        ending = write_rows(foam, "action=writeNow\n");
    free(foam->face);
    free(foam->at);
    free(foam);
    exchange->state = NULL;
    return status ? status : ending;
}

const struct partner partner_openfoam = {openfoam_plan, NULL,          openfoam_begin,
                                         openfoam_next, openfoam_give, openfoam_end};
