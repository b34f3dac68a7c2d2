/* test_couple.c - `fibrad couple` beside a stand-in of preCICE (tests/partner/precice.c). SPDX-License-Identifier: MIT
 */
#include "host_owned.h"
#include "program.h"

static const char *config, *bed, *box, *received;

/* A closed box of 12 triangles of equal areas, seen from inside. */
static const char *write_box(void) {
    static const int face[12][3] = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                    {2, 7, 3}, {2, 6, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    char text[4000] = "solid box\n";
    for (int k = 0; k < 12; ++k) {
        strcat(text, "facet normal 0 0 0\nouter loop\n");
        for (int c = 0; c < 3; ++c) {
            const int v = face[k][c];
            snprintf(text + strlen(text), 60, "vertex %g %g %g\n", .1 * (v & 1), .1 * (v >> 1 & 1), .1 * (v >> 2));
        }
        strcat(text, "endloop\nendfacet\n");
    }
    return write_file("oven.stl", strcat(text, "endsolid box\n"));
}

static const char *write_bed(void) {
    char text[2000] = "x [m],y [m],z [m],r [m],P [W]\n";
    for (int k = 0; k < 27; ++k)
        snprintf(text + strlen(text), 70, "%g,%g,%g,0.012,%d\n", .02 + .03 * (k % 3), .02 + .03 * (k / 3 % 3),
                 .02 + .03 * (k / 9), k == 13 ? 20 : 1);
    return write_file("bed.csv", text);
}

/* Contacts of some spheres with the box, which is the second end of one. */
static const char *write_contacts(void) {
    return write_file("contacts.csv",
                      "i,j,W/K\noven,0,0.05\n2,oven,0.02\noven,13,0.1\noven,26,0.01\n0,1,0.3\n12,13,1\n");
}

/* A configuration of preCICE. of_bed: what the participant Bed has. */
static const char *write_config(const char *of_bed) {
    return write_file("config.xml", formatted("<!-- <participant name=\"Ghost\"> --><precice-configuration>\n"
                                              "<participant name=\"Other\"><provide-mesh name=\"Other-Mesh\" />\n"
                                              "</participant><participant name=\"Bed\">\n%s</participant>\n"
                                              "</precice-configuration>\n",
                                              of_bed));
}

#define FACES     "<provide-mesh name=\"Bed-oven\"/><write-data name=\"Power\" mesh=\"Bed-oven\"/>\n"
#define DIRICHLET FACES "<read-data name=\"Temperature\" mesh=\"Bed-oven\"/>\n"
#define ROBIN                                                                                                          \
    FACES "<read-data name=\"Sink-Temperature\" mesh=\"Bed-oven\"/>\n"                                                 \
          "<read-data name=\"Heat-Transfer-Coefficient\" mesh=\"Bed-oven\"/>\n"
#define GAS                                                                                                            \
    "<provide-mesh name=\"Bed-Particles\"/><read-data name=\"Gas-Temperature\" mesh=\"Bed-Particles\"/>\n"             \
    "<write-data name=\"Gas-Power\" mesh=\"Bed-Particles\"/>\n"
#define AREA_OF_FACE .005

static void begin(void) {
    make_folder();
    setenv("LD_LIBRARY_PATH", formatted("%s/tests/partner", build), 1);
    received = in_folder("received");
    setenv("RECEIVED", received, 1);
    bed = write_bed(), box = formatted("mesh:%s:name=oven:temperature=300:emissivity=0.7", write_box());
    config = write_config(DIRICHLET);
}

static void end(void) {
    for (size_t k = 0; k < 9; ++k)
        unsetenv((const char *const[]){"RECEIVED", "WINDOWS", "LENGTH", "IMPLICIT", "FAULT", "VERSION", "AROUND",
                                       "LEAK", "FILM"}[k]);
    remove_folder();
}

FIXTURE(begin, end)

#define MATTER  "--emissivity", "0.8", "--temperature", "500", "--heat-capacity", "800", "--density", "2500"
#define ROUGHLY "--directions", "16", "--patches", "24", "--wall-rays", "4000", "--threads", "1"
#define BED     "couple", bed, "--precice", config, "--participant", "Bed", MATTER, "--wall", box, ROUGHLY

/* Value k of line i of the file of the stand-in: two lines a time window, what it has received and a first vertex. */
static double received_at(int i, int k) {
    const char *at = read_file(received);
    for (; i > 0; --i) at = strchr(at, '\n') + 1;
    for (; k > 0; --k) at = strchr(at, ' ') + 1;
    return strtod(at, NULL);
}

/* Sums of a key over all time windows of a file of --json. */
static double sum_of(const char *path, const char *key) {
    double sum = 0;
    const char *wanted = formatted("\"%s\": ", key);
    for (const char *at = read_file(path), *window; (window = strstr(at, "\"window\"")); at = window + 1) {
        const char *found = strstr(window, wanted);
        ck_assert_ptr_nonnull(found);
        sum += strtod(found + strlen(wanted), NULL);
    }
    return sum;
}

/* Both sides count the same energy, and the bed stores what it does not give. */
static void assert_energy(const char *json, int gas) {
    double faces = 0, to_gas = 0;
    for (int k = 0; k < 2; ++k) faces += received_at(2 * k, 0), to_gas += gas ? received_at(2 * k, 1) : 0;
    assert_near(sum_of(json, "faces_J"), faces, 1e-9);
    if (gas) assert_near(sum_of(json, "gas_J"), to_gas, 1e-9);
    assert_near(sum_of(json, "wall_oven_J"), faces, 1e-9);
    assert_near(sum_of(json, "stored_J"), -(faces + to_gas), 1e-9);
}

TEST(energy_of_windows) {
    const char *json = in_folder("q.json");
    setenv("WINDOWS", "2", 1);
    for (int implicit = 0; implicit < 2; ++implicit) {
        setenv("IMPLICIT", implicit ? "1" : "0", 1), setenv("LEAK", "0.3", 1);
        config = write_config(DIRICHLET GAS);
        SUCCEED(BED, "--convection", "20", "--json", json, "--step", "50", "--plot", in_folder("q.svg"), "--contacts",
                write_contacts());
        assert_energy(json, 1);
        ck_assert(implicit ? sum_of(json, "iterations") > 8 : sum_of(json, "iterations") == 2);
        unlink(received);
    }
}

/* With temperatures that do not change, time windows are steps of the same run. There a wall in contact has one
 * temperature. */
TEST(as_heat_alone) {
    const char *q = in_folder("q.csv"), *other = in_folder("other.csv");
    config = write_config(DIRICHLET GAS);
    SUCCEED(BED, "--convection", "20", "--step", "10", "-o", q, "--times", "every:150", "--contacts", write_contacts());
    SUCCEED("heat", bed, MATTER, "--wall", box, "--convection", "20", "--gas-temperature", "300", ROUGHLY, "--until",
            "300", "--step", "10", "--times", "200,300", "-o", other, "--contacts", write_contacts());
    const char *a = read_file(q), *b = read_file(other);
    for (int k = 0; k < 2 * 27; ++k) {
        do a = strchr(a, '\n') + 1, b = strchr(b, '\n') + 1;
        while (strchr(a, ',')[1] == '-');
        const char *x = strchr(strchr(a, ',') + 1, ',') + 1, *y = strchr(strchr(b, ',') + 1, ',') + 1;
        assert_near(strtod(x, NULL), strtod(y, NULL), 1e-8);
    }
}

/* A wall that conducts, by temperatures and by films: the same in a steady state. */
TEST(films_and_temperatures_agree) {
    double face[2][2];
    setenv("LENGTH", "1e7", 1), setenv("LEAK", "0.25", 1), setenv("FILM", "50", 1), setenv("IMPLICIT", "1", 1);
    ck_assert_double_eq(50 * AREA_OF_FACE, .25);
    for (int films = 0; films < 2; ++films) {
        const int windows = films ? 14 : 2; /* a face with a film takes what contacts brought in the last time window */
        setenv("WINDOWS", formatted("%d", windows), 1);
        config = write_config(films ? ROBIN : DIRICHLET);
        SUCCEED(BED, "--power", "P", "--step", "1e7", "--contacts", write_contacts());
        for (int k = 0; k < 2; ++k) face[films][k] = received_at(2 * windows - 1, k);
        face[films][0] = films ? 300 + face[1][1] / .25 : face[0][0];
        assert_near(received_at(2 * windows - 2, 0), 46e7, 1e-6);
        unlink(received);
    }
    assert_near(face[0][1], face[1][1], 1e-5); /* the residual of time windows that are not repeated */
    assert_near(face[0][0], face[1][0], 1e-6);
}

static void refuse(int status, const char *reason, const char *of_bed) {
    config = write_config(of_bed);
    FAIL_WITH(status, BED, "--quiet");
    assert_has(said, reason);

    ck_assert_ptr_eq(strchr(said, '\n'), said + strlen(said) - 1);
}

TEST(bad_input) {
    FAIL_WITH(2, "couple", bed, "--precice", config, "--participant", "Bad", MATTER);
    expect_message(config, "there is no participant Bad; there are Other, Bed");
    refuse(2, "the name of the mesh Bed-tube ends neither in the name of a wall of triangles nor",
           "<provide-mesh name=\"Bed-tube\"/>");
    refuse(2, "Bed-oven reads Pressure; faces read Temperature",
           FACES "<read-data name=\"Pressure\" mesh=\"Bed-oven\"/>");
    refuse(2, "Bed-oven reads only one of Heat-Transfer-Coefficient and Sink",
           FACES "<read-data name=\"Sink-Temperature\" mesh=\"Bed-oven\"/>");
    refuse(2, "particles read a Temperature but no Heat-Transfer-Coefficient; --convection H gives one", GAS);
    refuse(2, "the participant Bed provides no mesh", "");
    setenv("FAULT", "zero", 1);
    refuse(3, "preCICE gives Temperature of Bed-oven as 0 at vertex 6; a temperature above 0 K is expected", DIRICHLET);
    setenv("VERSION", "2.5.0;", 1);
    refuse(4, "this is preCICE 2.5.0; version 3 is needed", DIRICHLET);
    setenv("LD_LIBRARY_PATH", "/nowhere", 1);
    refuse(4, "libprecice.so.3 cannot be loaded", DIRICHLET);
    box = formatted("mesh:%s:name=oven:temperature=300:emissivity=0", in_folder("oven.stl"));
    refuse(2, "--wall: oven has faces of preCICE and needs an emissivity above 0", DIRICHLET);
}

/* The outputs of time windows that have ended stay. */
TEST(a_partner_dies) {
    const char *q = in_folder("q.csv"), *json = in_folder("q.json");
    setenv("FAULT", "die", 1);
    FAIL_WITH(4, BED, "-o", q, "--json", json);
    assert_has(said, "preCICE has ended with an error, which it has printed");
    assert_has(read_file(q), "\n100,");
    assert_near(json_of(json, "until_s"), 100, 0);
}
