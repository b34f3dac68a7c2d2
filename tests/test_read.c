/* test_read.c - readers: every format, every fault with its line. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/message.h"
#include "read/read.h"
#include "suite.h"

static char path[200];
static char said[4096]; /* on standard error by the last `try` */
static struct bed bed;

static void make_file(void) {
    const char *build = getenv("BUILD");
    snprintf(path, sizeof path, "%.100s/tests/read_XXXXXX", build ? build : "build");
    const int file = mkstemp(path);
    ck_assert_int_ge(file, 0);
    close(file);
}

static void remove_file(void) {
    unlink(path);
    bed_free(&bed);
}

/* Reads a text as a file and keeps what was said. */
static int try_options(const char *text, size_t size, const struct read_options *options) {
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(text, 1, size, file), size);
    fclose(file);
    FILE *catch = tmpfile();
    fflush(stderr);
    const int screen = dup(STDERR_FILENO);
    dup2(fileno(catch), STDERR_FILENO);
    bed_free(&bed);
    const int status = read_bed(path, options, &bed);
    dup2(screen, STDERR_FILENO);
    close(screen);
    rewind(catch);
    said[fread(said, 1, sizeof said - 1, catch)] = 0;
    fclose(catch);
    return status;
}

static int try(const char *text) { return try_options(text, strlen(text), &(struct read_options){0}); }

static void expect_sphere(uint32_t i, double x, double y, double z, double r, uint64_t line) {
    ck_assert_uint_lt(i, bed.n);
    ck_assert_double_eq(bed.x[i], x);
    ck_assert_double_eq(bed.y[i], y);
    ck_assert_double_eq(bed.z[i], z);
    ck_assert_double_eq(bed.r[i], r);
    ck_assert_uint_eq(bed.line[i], line);
}

/* The text must be refused in one line that names the file, the line (0: none) and the reason. */
static void expect_refusal(const char *text, size_t size, const struct read_options *options, unsigned line,
                           const char *reason) {
    char place[300];
    const int status = try_options(text, size, options);
    ck_assert_msg(status == STATUS_INPUT, "status %d: %s", status, text);
    if (line)
        snprintf(place, sizeof place, "fibrad: %s:%u: ", path, line);
    else
        snprintf(place, sizeof place, "fibrad: %s: ", path);
    ck_assert_msg(strncmp(said, place, strlen(place)) == 0, "'%s' does not begin with '%s'", said, place);
    ck_assert_msg(strstr(said, reason) != NULL, "'%s' does not give as reason '%s'", said, reason);
    ck_assert_ptr_eq(strchr(said, '\n'), said + strlen(said) - 1);
}

START_TEST(csv_in_any_order) {
    ck_assert_int_eq(try("name,r,z,y,x\r\n\"a,\"\"b\",0.5, 3 ,\"2\",1\r\n\n# comment\nb , 1e-1,-3,-2,-1"), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(0, 1, 2, 3, 0.5, 2);
    expect_sphere(1, -1, -2, -3, 0.1, 5);
    ck_assert(bed.period[0] == 0 && bed.period[1] == 0 && bed.period[2] == 0);
}
END_TEST

START_TEST(csv_after_byte_order_mark_and_comments) {
    ck_assert_int_eq(try("\xEF\xBB\xBF# made by hand\n\nx,y,z,diameter\n1,2,3,1\n"), 0);
    expect_sphere(0, 1, 2, 3, 0.5, 4);
    ck_assert_int_eq(try("\xEF\xBB\xBFx,y,z,radius\n1,2,3,1\n"), 0);
    expect_sphere(0, 1, 2, 3, 1, 2);
}
END_TEST

START_TEST(further_columns_by_name) {
    const char *const names[] = {"emissivity", "T"};
    const char text[] = "T,x,y,z,r,emissivity,id\n300,0,0,0,1,0.8,17\n400,3,0,0,1,0.9,-4\n";
    const struct read_options options = {.extra = names, .extras = 2};
    ck_assert_int_eq(try_options(text, sizeof text - 1, &options), 0);
    ck_assert_double_eq(bed.extra[0], 0.8);
    ck_assert_double_eq(bed.extra[1], 300);
    ck_assert_double_eq(bed.extra[2], 0.9);
    ck_assert_double_eq(bed.extra[3], 400);
    ck_assert_int_eq(bed.id[0], 17);
    ck_assert_int_eq(bed.id[1], -4);
    const char bad[] = "x,y,z,r,emissivity,T,id\n0,0,0,1,dark,1,1\n";
    expect_refusal(bad, sizeof bad - 1, &options, 2, "emissivity is not a number: 'dark'");
    const char lacking[] = "x,y,z,r,emissivity,id\n0,0,0,1,1,1\n";
    expect_refusal(lacking, sizeof lacking - 1, &options, 1, "no column T");
    const char text_id[] = "x,y,z,r,emissivity,T,id\n0,0,0,1,1,1,1.5\n";
    expect_refusal(text_id, sizeof text_id - 1, &options, 2, "the id is not a whole number: '1.5'");
}
END_TEST

#define FRAME(bounds, columns)                                                                                         \
    "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS" bounds "\n-1 3\n0 10\n0 2e1\nITEM: ATOMS " columns \
    "\n"

START_TEST(dump_columns_by_name) {
    ck_assert_int_eq(try(FRAME(" pp ff mm ", "id type z y x radius ") "9 1 3 2 1 .5 \n4 1 6 5 4 1 \n"), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(0, 1, 2, 3, 0.5, 10);
    expect_sphere(1, 4, 5, 6, 1, 11);
    ck_assert(bed.period[0] == 4 && bed.period[1] == 0 && bed.period[2] == 0);
    ck_assert(bed.low[0] == -1 && bed.high[2] == 20);
}
END_TEST

START_TEST(dump_scaled_unwrapped_diameter) {
    ck_assert_int_eq(try(FRAME("", "xs ys zs diameter") "0.25 0.5 1 3\n0 0 0 1\n"), 0);
    expect_sphere(0, 0, 5, 20, 1.5, 10);
    expect_sphere(1, -1, 0, 0, 0.5, 11);
    ck_assert_int_eq(try(FRAME(" pp pp pp", "xu yu zsu radius") "105 -7 0.5 1\n0 0 0 1\n"), 0);
    expect_sphere(0, 105, -7, 10, 1, 10);
    ck_assert(bed.period[0] == 4 && bed.period[1] == 10 && bed.period[2] == 20);
    ck_assert_int_eq(try(FRAME(" pp pp pp", "xs x y z radius") "0.5 1 2 3 1\n0 0 0 0 1\n"), 0);
    expect_sphere(0, 1, 2, 3, 1, 10);
}
END_TEST

#define TWO_FRAMES                                                                                                     \
    FRAME(" pp pp pp", "x y z radius")                                                                                 \
    "0 0 0 1\n3 0 0 1\n"                                                                                               \
    "ITEM: UNITS\nlj\nITEM: TIME\n0.5\nITEM: TIMESTEP\n8\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS r z y x\n4 3 2 1\n"

START_TEST(dump_frames) {
    struct read_options options = {.frame = -1};
    for (options.frame = -1; options.frame < 2; options.frame += 2) {
        ck_assert_int_eq(try_options(TWO_FRAMES, strlen(TWO_FRAMES), &options), 0);
        ck_assert_uint_eq(bed.n, 1);
        expect_sphere(0, 1, 2, 3, 4, 21);
        ck_assert(bed.period[0] == 0); /* the second frame has no box */
    }
    options.frame = 0;
    ck_assert_int_eq(try_options(TWO_FRAMES "ITEM: TIMESTEP\n", strlen(TWO_FRAMES) + 15, &options), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(1, 3, 0, 0, 1, 11);
    options.frame = 2;
    expect_refusal(TWO_FRAMES, strlen(TWO_FRAMES), &options, 0, "there is no frame 2; the last is 1");
    const char csv[] = "x,y,z,r\n0,0,0,1\n";
    expect_refusal(csv, sizeof csv - 1, &options, 0, "there is no frame 2");
}
END_TEST

START_TEST(yade) {
    ck_assert_int_eq(try("#format x_y_z_r_matId\n# comment\n1\t2\t3\t0.5\t0\n4 5 6 1 0\n"), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(0, 1, 2, 3, 0.5, 3);
    expect_sphere(1, 4, 5, 6, 1, 4);
}
END_TEST

START_TEST(settled_beds) {
    static const struct {
        const char *file;
        double period, radius_min, radius_max;
    } beds[] = {{"tests/data/mono2000.dump", 0, 0.5, 0.5},
                {"tests/data/poly2000.dump", 0, 0.4, 0.6},
                {"tests/data/monoper2000.dump", 12, 0.5, 0.5}};
    for (size_t k = 0; k < 3; ++k) {
        const char *const names[] = {"v_T"};
        bed_free(&bed);
        ck_assert_int_eq(read_bed(beds[k].file, &(struct read_options){.extra = names, .extras = 1}, &bed), 0);
        ck_assert_uint_eq(bed.n, 2000);
        ck_assert(bed.period[0] == beds[k].period && bed.period[1] == beds[k].period && bed.period[2] == 0);
        for (uint32_t i = 0; i < bed.n; ++i) {
            ck_assert(bed.r[i] >= beds[k].radius_min && bed.r[i] <= beds[k].radius_max);
            ck_assert(bed.extra[i] >= 299 && bed.extra[i] <= 1001);
            ck_assert_uint_eq(bed.line[i], i + 10);
        }
    }
}
END_TEST

/* More spheres than the arrays begin with. */
START_TEST(growth) {
    enum { N = 5000 };
    char *text = malloc(64 * N), *end = text;
    ck_assert_ptr_nonnull(text);
    end += sprintf(end, "x,y,z,r,id\n");
    for (int i = 0; i < N; ++i) end += sprintf(end, "%d,%d,%d,1,%d\n", i, 2 * i, 3 * i, N - i);
    ck_assert_int_eq(try_options(text, (size_t)(end - text), &(struct read_options){0}), 0);
    free(text);
    ck_assert_uint_eq(bed.n, N);
    for (uint32_t i = 0; i < N; ++i) {
        expect_sphere(i, i, 2. * i, 3. * i, 1, i + 2);
        ck_assert_int_eq(bed.id[i], N - (int64_t)i);
    }
}
END_TEST

#define HEAD   "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n"
#define BOX    "ITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
#define ATOMS  "ITEM: ATOMS x y z radius\n"
#define SPHERE "0 0 0 1\n"

static const struct {
    unsigned line;
    const char *text, *reason;
} refused[] = {
    {0, "", "no spheres"},
    {0, "\n\n# nothing\n", "no spheres"},
    {0, "x,y,z,r\n", "no spheres"},
    {1, "x,y,r\n0,0,1\n", "no column z"},
    {1, "x,y,z\n0,0,1\n", "no column r"},
    {1, "0,0,0,1\n", "no column x"},
    {2, "#\nx,y,z,r,x\n0,0,0,1,2\n", "two columns are named x"},
    {3, "x,y,z,r\n0,0,0,1\n3,nan,0,1\n", "y is not finite"},
    {3, "x,y,z,r\n0,0,0,1\n3,0,-inf,1\n", "z is not finite"},
    {2, "x,y,z,r\n1e999,0,0,1\n", "x is not finite"},
    {2, "x,y,z,r\n0,0,foo,1\n", "z is not a number: 'foo'"},
    {2, "x,y,z,r\n0,0,1 2,1\n", "z is not a number: '1 2'"},
    {2, "x,y,z,r\n0,0,,1\n", "z is not a number: ''"},
    {2, "x,y,z,r\n0,0,1\n", "3 fields where the header names 4 columns"},
    {3, "x,y,z,r\n0,0,0,1\n0,0,1,1,1\n", "5 fields where the header names 4 columns"},
    {2, "x,y,z,r\n0,0,0,0\n", "the radius is 0; it must be above 0"},
    {2, "x,y,z,r\n0,0,0,-1\n", "the radius is -1"},
    {2, "x,y,z,r\n0,0,0,nan\n", "the radius is not finite"},
    {2, "x,y,z,r\n0,0,\"0,1\n", "a quoted field does not end"},
    {2, "x,y,z,r\n0,0,\"0\"0,1\n", "a quoted field does not end"},
    {1, "#format x_y_z\n0 0 0\n", "no column r"},
    {2, "#format x_y_z_r\n0 0 0\n", "3 fields"},
    {4, HEAD "2\n", "the file ends within a frame"},
    {3, HEAD, "the file ends within a frame"},
    {1, "ITEM: TIMESTEP\n", "the file ends within a frame"},
    {4, HEAD "many\n" BOX ATOMS SPHERE, "the number of atoms is not a whole number: 'many'"},
    {4, HEAD "-1\n" BOX ATOMS SPHERE, "the number of atoms is negative"},
    {4, HEAD "1 1\n" BOX ATOMS SPHERE, "the number of atoms is expected"},
    {4, HEAD BOX ATOMS SPHERE, "a section begins where lines of the one before are missing"},
    {4, HEAD "99999999999999999999\n" BOX ATOMS SPHERE, "not a whole number"},
    {10, HEAD "99999999999\n" BOX ATOMS SPHERE, "the frame ends after 1 atoms; 99999999999 were declared"},
    {11, HEAD "3\n" BOX ATOMS SPHERE SPHERE, "the frame ends after 2 atoms; 3 were declared"},
    {11, HEAD "2\n" BOX ATOMS SPHERE HEAD "1\n", "the frame ends after 1 atoms; 2 were declared"},
    {11, HEAD "1\n" BOX ATOMS SPHERE SPHERE, "more atoms than declared"},
    {10, HEAD "1\n" BOX ATOMS "0 0 0\n", "3 fields where the header names 4 columns"},
    {10, HEAD "1\n" BOX ATOMS "0 zero 0 1\n", "y is not a number: 'zero'"},
    {11, HEAD "2\n" BOX ATOMS SPHERE "0 0 NaN 1\n", "z is not finite"},
    {9, HEAD "1\n" BOX "ITEM: ATOMS x y z\n0 0 0\n", "no column r"},
    {9, HEAD "1\n" BOX "ITEM: ATOMS xs y radius\n0 0 0\n", "no column z"},
    {5,
     HEAD "1\n"
          "ITEM: ATOMS xs y z r\n0 0 0 1\n",
     "scaled coordinates need ITEM: BOX BOUNDS"},
    {0, "ITEM: ATOMS x y z r\n0 0 0 1\n", "no frame"},
    {3, "ITEM: TIMESTEP\n0\n" ATOMS SPHERE, "before ITEM: NUMBER OF ATOMS"},
    {5, HEAD "1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 0\n0 1 0\n0 1 0\n" ATOMS SPHERE, "triclinic"},
    {5, HEAD "1\nITEM: BOX BOUNDS abc origin pp pp pp\n0 1 0 0\n0 1 0 0\n0 1 0 0\n" ATOMS SPHERE, "triclinic"},
    {5, HEAD "1\nITEM: BOX BOUNDS pp pq pp\n0 1\n0 1\n0 1\n" ATOMS SPHERE, "unknown boundary mark 'pq'"},
    {7, HEAD "1\nITEM: BOX BOUNDS pp pp pp\n0 1\n1 1\n0 1\n" ATOMS SPHERE, "the box is empty"},
    {7, HEAD "1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 inf\n0 1\n" ATOMS SPHERE, "the upper bound is not finite"},
    {7, HEAD "1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0\n0 1\n" ATOMS SPHERE, "the two bounds of the box"},
    {0, HEAD "0\n" BOX ATOMS, "no spheres"},
    {5, HEAD "1\n" HEAD "1\n" BOX ATOMS SPHERE, "a frame begins where atoms of the one before are missing"},
};

START_TEST(faults) {
    expect_refusal(refused[_i].text, strlen(refused[_i].text), &(struct read_options){0}, refused[_i].line,
                   refused[_i].reason);
}
END_TEST

START_TEST(binary_data) {
    const char zeros[] = "x,y,z,r\n0,0,0,\0001\n";
    expect_refusal(zeros, sizeof zeros - 1, &(struct read_options){0}, 2, "binary data");
    expect_refusal("\x1f\x8b\x08 gzip", 8, &(struct read_options){0}, 0, "compressed");
    char *endless = malloc(3 << 20);
    ck_assert_ptr_nonnull(endless);
    memset(endless, '1', 3 << 20);
    expect_refusal(endless, 3 << 20, &(struct read_options){0}, 1, "the line has no end");
    free(endless);
}
END_TEST

START_TEST(unreadable) {
    static const char *const paths[] = {"no/such/file.csv", "tests"};
    for (size_t k = 0; k < 2; ++k) {
        bed_free(&bed);
        ck_assert_int_eq(read_bed(paths[k], &(struct read_options){0}, &bed), STATUS_FILE);
    }
}
END_TEST

int main(void) {
    Suite *suite = suite_create("read");
    TCase *formats = suite_case(suite, "formats"), *bad = suite_case(suite, "faults");
    tcase_add_checked_fixture(formats, make_file, remove_file);
    tcase_add_checked_fixture(bad, make_file, remove_file);
    tcase_add_test(formats, csv_in_any_order);
    tcase_add_test(formats, csv_after_byte_order_mark_and_comments);
    tcase_add_test(formats, further_columns_by_name);
    tcase_add_test(formats, dump_columns_by_name);
    tcase_add_test(formats, dump_scaled_unwrapped_diameter);
    tcase_add_test(formats, dump_frames);
    tcase_add_test(formats, yade);
    tcase_add_test(formats, settled_beds);
    tcase_add_test(formats, growth);
    tcase_add_loop_test(bad, faults, 0, (int)(sizeof refused / sizeof *refused));
    tcase_add_test(bad, binary_data);
    tcase_add_test(bad, unreadable);
    return suite_run(suite);
}
