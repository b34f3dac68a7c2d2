/* test_partner_openfoam.c - `fibrad couple` beside a process that takes OpenFOAM's turns. SPDX-License-Identifier: MIT
 *
 * The bed is in a box of 12 triangles. OpenFOAM has its 6 faces, in two patches. Behind each face is a fluid. */
#include <time.h>

#include "partner/partner.h"
#include "program.h"

enum { FACES = 6, WINDOWS = 12 };
#define LENGTH 1e5 /* [s] of a time window, and of a step: the bed is soon steady */
#define POWER  46  /* [W] of all spheres */

static const int quad[FACES][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
static char *bed, *box, *lock, *group, *out, *in, *received;

/* What OpenFOAM does in this test. */
static int external;      /* initByExternal */
static double unlike;     /* [K] from the temperature of one fluid to the next */
static const char *fault; /* what goes wrong */
static int has_fault(const char *name) { return fault && strcmp(fault, name) == 0; }

static double corner_of(int v, int axis) { return .1 * (v >> axis & 1); }

/* ---- OpenFOAM, in its own process -------------------------------------------------------------------------------- */

static FILE *begin_file(const char *path) {
    FILE *file = fopen(path, "w");
    if (!file) _exit(90);
    return file;
}

static void put(const char *path, const char *text) {
    FILE *file = begin_file(path);
    fputs(text, file);
    fclose(file);
}

/* Each patch has all corners of the box, and three faces. */
static void write_geometry(void) {
    FILE *points = begin_file(formatted("%s/patchPoints", group)),
         *faces = begin_file(formatted("%s/patchFaces", group));
    const double scale = has_fault("units") ? 1000 : 1;
    for (int patch = 0; patch < 2; ++patch) {
        fprintf(points, "// Group: air\n// Patch: region0 p%d\n%d\n(\n", patch, 8);
        for (int v = 0; v < 8; ++v)
            fprintf(points, "(%g %g %g)\n", scale * corner_of(v, 0), scale * corner_of(v, 1),
                    scale * corner_of(v, 2) + has_fault("elsewhere"));
        fprintf(faces, "// Patch: region0 p%d\n%d\n(\n", patch, 3 + (has_fault("bare") && patch));
        for (int k = 3 * patch; k < 3 * patch + 3; ++k)
            fprintf(faces, "4(%d %d %d %d)\n", quad[k][0], quad[k][1], quad[k][2], quad[k][3]);
        fputs(has_fault("bare") && patch ? "3(0 1 7)\n)\n\n" : ")\n\n", faces);
        fputs(")\n\n", points);
    }
    fclose(points);
    fclose(faces);
    const struct timespec old[2] = {{.tv_nsec = UTIME_NOW}, {0}};
    utimensat(AT_FDCWD, formatted("%s/patchFaces", group), old, 0);
}

/* Waits for our files, and reads them. Returns whether they ask for the end. */
static int wait_for_rows(double wall[FACES + 1]) {
    char text[40] = "";
    unlink(lock);
    while (access(lock, F_OK) != 0) nanosleep(&(const struct timespec){.tv_nsec = 2000000}, NULL);
    unlink(out);
    FILE *file = fopen(in, "r");
    for (int k = 0; k < FACES + has_fault("bare"); ++k) {
        double gradient, fraction;
        if (!file || fscanf(file, "%lf %lf %lf", &wall[k], &gradient, &fraction) != 3 || gradient != 0) _exit(91);
    }
    if (fscanf(file, "%39s", text) == 1) _exit(92);
    fclose(file);
    file = fopen(lock, "r");
    if (!file || fscanf(file, "%39s", text) != 1) _exit(93);
    fclose(file);
    return strcmp(text, "action=writeNow") == 0;
}

static void write_out(const double *wall, int window) {
    FILE *file = begin_file(out);
    double energy = 0;
    const int strange = window == 1 ? FACES - 1 : -1;
    fprintf(file, "# Values: area Twall qDot htc\n");
    for (int k = 0; k < FACES - (has_fault("few") && window == 1); ++k) {
        const double fluid = 300 + unlike * k, film = 20 + 10 * k, flux = film * (wall[k] - fluid);
        energy += .01 * flux * LENGTH;
        const char *first = k == strange && has_fault("zero")  ? "0"
                            : k == strange && has_fault("nan") ? "nan"
                            : k == strange && has_fault("row") ? ""
                                                               : NULL;
        fprintf(file, "%.17g %s %.17g %.17g\n", k == strange && has_fault("old") ? .02 : .01,
                first ? first : formatted("%.17g", wall[k]), flux, fabs(wall[k] - fluid) > 1e-3 ? film : 0);
    }
    if (has_fault("many") && window == 1) fputs("0.01 300 0 1\n", file);
    fclose(file);
    file = fopen(received, "a");
    fprintf(file, "%.17g\n", energy);
    fclose(file);
}

/* Exits with 0, or 1 if it was asked to end. */
static void play(void) {
    double wall[FACES + 1] = {300, 300, 300, 300, 300, 300};
    int asked = 0;
    alarm(100);
    put(lock, "status=done\n"); /* of an earlier run */
    mkdir(group, 0777);
    write_geometry();
    if (has_fault("groups")) mkdir(in_folder("b"), 0777), put(in_folder("b/patchFaces"), "");
    if (external) wait_for_rows(wall);
    for (int window = 0, windows = WINDOWS; window < windows; ++window) {
        write_out(wall, window);
        if (has_fault("die") && window == 1) put(lock, "status=openfoam\n"), _exit(0);
        if (wait_for_rows(wall) && !asked) asked = 1, windows = window + 2; /* one more step, and one more exchange */
    }
    unlink(in);
    put(lock, "status=done\n");
    _exit(asked);
}

/* ---- the bed ----------------------------------------------------------------------------------------------------- */

static const char *write_box(void) {
    char text[5000] = "solid oven\n";
    for (int t = 0; t < 2 * FACES; ++t) {
        strcat(text, "facet normal 0 0 0\nouter loop\n");
        for (int c = 0; c < 3; ++c) {
            const int v = quad[t / 2][c == 0 ? 0 : c + t % 2];
            strcat(text, formatted("vertex %g %g %g\n", corner_of(v, 0), corner_of(v, 1), corner_of(v, 2)));
        }
        strcat(text, "endloop\nendfacet\n");
    }
    return write_file("oven.stl", strcat(text, "endsolid oven\n"));
}

static const char *write_bed(void) {
    char text[2000] = "x [m],y [m],z [m],r [m],P [W]\n";
    for (int k = 0; k < 27; ++k)
        strcat(text, formatted("%g,%g,%g,0.012,%d\n", .02 + .03 * (k % 3), .02 + .03 * (k / 3 % 3), .02 + .03 * (k / 9),
                               k == 13 ? 20 : 1));
    return write_file("bed.csv", text);
}

static void begin(void) {
    make_folder();
    bed = strdup(write_bed()), box = strdup(formatted("mesh:%s:temperature=400:emissivity=0.7", write_box()));
    group = strdup(in_folder("air")), lock = strdup(in_folder("OpenFOAM.lock")),
    received = strdup(in_folder("received"));
    out = strdup(in_folder("air/T.out")), in = strdup(in_folder("air/T.in"));
    external = 0, unlike = 5, fault = NULL;
}

static void end(void) {
    for (size_t k = 0; k < 5; ++k)
        unlink(in_folder(
            (const char *const[]){"air/T.out", "air/T.in", "air/patchFaces", "air/patchPoints", "b/patchFaces"}[k]));
    rmdir(group), rmdir(in_folder("b"));
    for (size_t k = 0; k < 7; ++k) free((char *const[]){bed, box, lock, group, out, in, received}[k]);
    remove_folder();
}

FIXTURE(begin, end)

#define BED                                                                                                            \
    "couple", bed, "--openfoam", folder, "--window", formatted("%g", LENGTH), "--wall", box, "--emissivity", "0.8",    \
        "--temperature", "500", "--heat-capacity", "800", "--density", "2500", "--power", "P", "--step",               \
        formatted("%g", LENGTH), "--threads", "1", "--directions", "16", "--patches", "24", "--wall-rays", "20000"

/* Runs both. Returns the exit status of the bed. *asked: OpenFOAM was asked to end. */
static int run_both(const char *const *arguments, int *asked) {
    int foam_end;
    const pid_t foam = fork();
    if (foam == 0) play();
    const int status = finish(start(arguments));
    ck_assert_int_eq(waitpid(foam, &foam_end, 0), foam);
    ck_assert_msg(WIFEXITED(foam_end) && WEXITSTATUS(foam_end) <= 1, "OpenFOAM has ended with %d; %s", foam_end, said);
    *asked = WEXITSTATUS(foam_end);
    return status;
}

/* In the end the bed gives what OpenFOAM takes, within the tolerance of the bed's solutions. Faces begin without films,
 * all or one of them. */
LOOP_TEST(energy, 3) {
    const char *json = in_folder("q.json"), *last;
    int asked;
    external = _i == 1, unlike = _i == 2 ? 0 : 5;
    const int status = run_both(LIST(BED, "--json", json, "--quiet"), &asked);
    ck_assert_msg(status == 0 && !asked && !*said, "%d %d %s", status, asked, said);
    ck_assert_double_eq(json_of(json, "until_s"), WINDOWS * LENGTH);
    last = strrchr(formatted("\n%.*s", (int)strlen(read_file(received)) - 1, read_file(received)), '\n');
    for (const char *at = read_file(json), *next; (next = strstr(at, "\"faces_J\"")); at = next + 1)
        if (!strstr(next + 1, "\"faces_J\"")) assert_near(strtod(next + 11, NULL), POWER * LENGTH, 1e-9);
    assert_near(strtod(last, NULL), POWER * LENGTH, 2e-5);
}

/* The heat that goes through films and triangles is what OpenFOAM counts with the temperatures it gets, also if areas
 * differ a little. */
TEST(watts_are_kept) {
    enum { TRIANGLES = 2 * FACES };
    double centre[TRIANGLES][3] = {{0}}, area[TRIANGLES], film[TRIANGLES], behind[TRIANGLES], found[TRIANGLES];
    double energy[WINDOWS + 1] = {0};
    int windows = 0, foam_end;
    bool again;
    struct exchange e = {.folder = folder, .window = LENGTH, .timeout = 60};
    e.faces = (struct exchange_faces){
        .n = TRIANGLES, .centre = centre, .area = area, .film = film, .behind = behind, .found = found};
    for (int t = 0; t < TRIANGLES; ++t) {
        area[t] = .005 + 1e-5 * t, found[t] = 300;
        for (int c = 0; c < 9; ++c)
            centre[t][c % 3] += corner_of(quad[t / 2][c / 3 == 0 ? 0 : c / 3 + t % 2], c % 3) / 3;
    }
    const pid_t foam = fork();
    if (foam == 0) play();
    ck_assert_int_eq(partner_openfoam.plan(&e), 0);
    ck_assert_int_eq(partner_openfoam.begin(&e), 0);
    while (partner_openfoam.next(&e) == 0 && e.length > 0) {
        ck_assert_double_eq(e.length, LENGTH);
        for (int t = 0; t < TRIANGLES; ++t) {
            ck_assert_double_eq_tol(behind[t], 300 + unlike * (t / 2), 1e-9);
            found[t] = 400 + 10 * t + windows;
            energy[windows] += film[t] * area[t] * (found[t] - behind[t]) * LENGTH;
        }
        ck_assert_int_eq(partner_openfoam.give(&e, &again), 0);
        ck_assert(!again && ++windows <= WINDOWS);
    }
    ck_assert_int_eq(partner_openfoam.end(&e, 0), 0);
    ck_assert_int_eq(waitpid(foam, &foam_end, 0), foam);
    ck_assert(foam_end == 0 && windows == WINDOWS);
    const char *line = read_file(received);
    for (int k = 0; k < WINDOWS - 1; ++k) { /* OpenFOAM has the temperatures a time window later */
        line = strchr(line, '\n') + 1;
        if (k > 0) assert_near(strtod(line, NULL), energy[k], 1e-12); /* in time window 0 a face has no film */
    }
}

/* One sentence, and OpenFOAM ends too. */
TEST(bad_input) {
    static const struct {
        const char *fault, *reason;
    } cases[] = {
        {"few", "T.out:6: the file ends too early"},
        {"many", "T.out:8: a row too many; patchFaces has 6 faces"},
        {"zero", "T.out:7: wall and fluid have 0 K"},
        {"nan", "T.out:7: wall and fluid have nan K"},
        {"old", "T.out:7: the face has 0.02 m2, but 0.01 m2 in patchFaces"},
        {"units", "the faces have 60000 m2, but the triangles of the bed have 0.06 m2; their units of length differ"},
        {"elsewhere", "12 of 12 triangles of the bed are at no face, the first at ("},
        {"bare", "1 of 7 faces are at no triangle of the bed, the first at (0.0"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        int asked;
        fault = cases[k].fault;
        const int status = run_both(LIST(BED, "--quiet"), &asked);
        expect_message(folder, cases[k].reason);
        ck_assert_msg(status == 3 && asked, "%s: %d %d", fault, status, asked);
    }
}

/* The outputs of time windows that have ended stay. */
TEST(openfoam_dies) {
    const char *json = in_folder("q.json");
    int asked;
    fault = "die";
    ck_assert_int_eq(run_both(LIST(BED, "--quiet", "--timeout", "0.5", "--json", json), &asked), 4);
    expect_message(folder, "OpenFOAM has not answered for 0.5");
    ck_assert_double_eq(json_of(json, "until_s"), LENGTH);
    FAIL_WITH(4, "couple", bed, "--openfoam", "nowhere", "--window", "1", "--wall", box, "--temperature", "500",
              "--heat-capacity", "800", "--density", "2500");
    expect_message("nowhere: ", "No such file");
}
