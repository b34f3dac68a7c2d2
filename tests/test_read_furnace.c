/* test_read_furnace.c - box files: every key, every fault with its line, and what is written.
 * SPDX-License-Identifier: MIT */
#include "papers/furnace/furnace.h"
#include "cli/message.h"
#include "one_file.h"

static fibrad_furnace_config config;

FIXTURE(make_file, remove_file)

/* Reads a text as a file and keeps the messages. */
static int try(const char *text) {
    write_file(text, strlen(text));
    begin_catching();
    const int status = read_furnace(path, &config);
    end_catching();
    return status;
}

#define WALLS "wall sides 900 0.7\nwall z0 1200 0.85\nwall z1 400 .7\n"

TEST(good_files) {
    static const char *const texts[] = {
        "size 2 2 4\ncells 20 20 40\nabsorption 0.15\nscattering 0.35\nsource 5000\n" WALLS,
        "# upside down\r\n\n" WALLS "\tsource 5e3 # W/m3\nscattering .35\n  cells 20 20 40\nabsorption .15\nsize 2 2 4",
        "size 2 2 4\ncells 20 20 40\nabsorption 0.15\nscattering 0.35\nsource 5000\nwall x0 900 0.7\nwall y1 900 0.7\n"
        "wall y0 900 0.7\nwall x1 900 0.7\nwall z1 400 0.7\nwall z0 1200 0.85\n"};
    fibrad_furnace_config published = furnace_case(2);
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        ck_assert_int_eq(try(texts[k]), 0);
        ck_assert_str_eq(said, "");
        for (int a = 0; a < 3; a++) {
            ck_assert_double_eq(config.size[a], published.size[a]);
            ck_assert_uint_eq(config.cells[a], published.cells[a]);
        }
        for (int w = 0; w < 6; w++) {
            ck_assert_double_eq(config.wall_temperature[w], published.wall_temperature[w]);
            ck_assert_double_eq(config.wall_emissivity[w], published.wall_emissivity[w]);
        }
        ck_assert_double_eq(config.absorption, 0.15);
        ck_assert_double_eq(config.scattering, 0.35);
        ck_assert_double_eq(config.source, 5000);
    }
    ck_assert_int_eq(try("size 1 1 1\ncells 1 1 1\nabsorption 1\n" WALLS), 0);
    ck_assert_double_eq(config.scattering, 0);
    ck_assert_double_eq(config.source, 0);
}

TEST(bad_files) {
    static const struct {
        const char *text, *line, *reason;
    } files[] = {
        {"size 2 2 4\nabsorption -0.5\n", ":2: ", "absorption must be above 0"},
        {"absorption 0\n", ":1: ", "absorption must be above 0"},
        {"\nscattering -1e-9\n", ":2: ", "scattering must be at least 0"},
        {"wall x0 900 1.2\n", ":1: ", "emissivity must be at most 1"},
        {"wall x0 900 -0.2\n", ":1: ", "emissivity must be at least 0"},
        {"wall x0 900 nan\n", ":1: ", "emissivity is not finite"},
        {"wall x0 0 0.5\n", ":1: ", "wall temperature must be above 0"},
        {"wall x0 -3 0.5\n", ":1: ", "wall temperature must be above 0"},
        {"wall top 900 0.5\n", ":1: ", "unknown wall 'top'"},
        {"wall x0 900\n", ":1: ", "wall takes 3 values, not 2"},
        {"wall sides 900 1\n# again\nwall y0 900 1\n", ":3: ", "wall y0 was given in line 1 already"},
        {"cells 20 0 40\n", ":1: ", "cells must be at least 1"},
        {"cells 20 -1 40\n", ":1: ", "cells must be at least 1"},
        {"cells 20 2.5 40\n", ":1: ", "cells is not a whole number"},
        {"cells 100000 100000 2\n", ":1: ", "no more than"},
        {"size 2 2\n", ":1: ", "size takes 3 values, not 2"},
        {"size 2 0 2\n", ":1: ", "size must be above 0"},
        {"size 2 2 inf\n", ":1: ", "size is not finite"},
        {"source hot\n", ":1: ", "source is not a number"},
        {"source 1\nsource 2\n", ":2: ", "source was given in line 1 already"},
        {"colour red\n", ":1: ", "unknown key 'colour'"},
        {"", ": ", "size is missing"},
        {"size 1 1 1\ncells 1 1 1\n" WALLS, ": ", "absorption is missing"},
        {"size 1 1 1\ncells 1 1 1\nabsorption 1\nwall sides 900 1\nwall z0 900 1\n", ": ", "wall z1 is missing"},
        {"size 1 1 1\ncells 1 1 1\nabsorption 1\nwall sides 9 0\nwall z0 9 0\nwall z1 9 0\n", ": ", "emissivity 0"},
        {"size 1 1 1\ncells 1 1 1\nabsorption 1e-12\n" WALLS, ": ", "out of range"},
    };
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        ck_assert_msg(try(files[k].text) == STATUS_INPUT, "accepted: %s", files[k].text);
        assert_begins(said, formatted("fibrad: %s%s", path, files[k].line));
        assert_has(said, files[k].reason);
        ck_assert_ptr_eq(strchr(said, '\n'), said + strlen(said) - 1);
    }
    unlink(path);
    ck_assert_int_eq(read_furnace("no/such/box.txt", &config), STATUS_FILE);
}

/* The files of both writers are read back. Positions lie in the box, T and E belong together, and there are as many
 * values as cells. */
TEST(written_fields) {
    fibrad_furnace_config box = furnace_case(1);
    struct furnace_options options = {.method = FURNACE_HFM, .threads = 1, .quiet = true};
    struct furnace_run run;
    char text[400];
    box.cells[0] = 3, box.cells[1] = 4, box.cells[2] = 5;
    ck_assert_int_eq(furnace_run(&box, &options, &run), 0);
    FILE *file = tmpfile();
    write_furnace_csv(file, &run);
    rewind(file);
    ck_assert_ptr_nonnull(fgets(text, sizeof text, file));
    ck_assert_str_eq(text, "x,y,z,T,E,divq\n");
    for (size_t k = 0; k < 60; k++) {
        double x, y, z, t, e, divergence;
        ck_assert_int_eq(fscanf(file, "%lf,%lf,%lf,%lf,%lf,%lf ", &x, &y, &z, &t, &e, &divergence), 6);
        ck_assert_double_eq_tol(x, ((double)(k % 3) + 0.5) * 2 / 3, 1e-15);
        ck_assert_double_eq_tol(y, ((double)(k / 3 % 4) + 0.5) * 2 / 4, 1e-15);
        ck_assert_double_eq_tol(z, ((double)(k / 12) + 0.5) * 4 / 5, 1e-15);
        ck_assert_double_eq(e, run.at.e[k]);
        ck_assert_double_eq_tol(FIBRAD_STEFAN_BOLTZMANN * t * t * t * t / e, 1, 1e-14);
        ck_assert_double_eq_tol(divergence, 5000, 1e-3);
    }
    ck_assert_int_eq(fgetc(file), EOF);
    fclose(file);

    file = tmpfile();
    write_furnace_vti(file, &run);
    rewind(file);
    int numbers = 0, arrays = 0;
    while (fgets(text, sizeof text, file)) {
        numbers += text[0] != ' ' && text[0] != '<';
        arrays += strstr(text, "<DataArray") != NULL;
    }
    ck_assert_int_eq(numbers, 180);
    ck_assert_int_eq(arrays, 3);
    fclose(file);
    furnace_free(&run);
}
