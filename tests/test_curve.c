/* test_curve.c - curves of tables against interpolation and integrals of GSL; names, units and order of their columns.
 * SPDX-License-Identifier: MIT */
#include <gsl/gsl_interp.h>
#include <math.h>

#include "cli/message.h"
#include "one_file.h"
#include "text/read_curve.h"
#include "text/unit.h"

enum { POINTS = 5 };
static double x[POINTS] = {300, 301, 450, 700, 1200}, y[POINTS] = {800, 900, 400, 400, 1300};
static const struct curve curve = {x, y, POINTS};
static gsl_interp *interp;

static void begin(void) {
    interp = gsl_interp_alloc(gsl_interp_linear, POINTS);
    gsl_interp_init(interp, x, y, POINTS);
    make_file();
}

static void end(void) {
    remove_file();
    gsl_interp_free(interp);
}

FIXTURE(begin, end)

/* The integral of y from the first point to `at`. */
static double integral(double at) {
    if (at < x[0]) return y[0] * (at - x[0]);
    const double last = x[POINTS - 1], inside = at < last ? at : last;
    return gsl_interp_eval_integ(interp, x, y, x[0], inside, NULL) + y[POINTS - 1] * (at - inside);
}

TEST(values) {
    for (double at = 300; at < 1200; at += 7.1)
        ck_assert_double_eq_tol(curve_at(&curve, at), gsl_interp_eval(interp, x, y, at, NULL), 1e-10);
    for (int k = 0; k < POINTS; ++k) ck_assert(curve_at(&curve, x[k]) == y[k]);
    ck_assert(curve_at(&curve, 200) == y[0] && curve_at(&curve, 2000) == y[POINTS - 1]);
}

/* The test goes from places inside, on points and outside, forth and back. */
TEST(ways_of_given_areas) {
    const double from[] = {-200, 250, 300, 300.5, 440, 450, 600, 1199, 1200, 1500};
    const double areas[] = {1e-3, 3, 900, 4e4, 2e5, 9e5};
    for (int k = 0; k < 60; ++k)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double area = sign * areas[k % 6], to = curve_advance(&curve, from[k / 6], area);
            ck_assert_double_eq_tol(integral(to) - integral(from[k / 6]), area, 1e-9);
            ck_assert_double_eq_tol(curve_advance(&curve, to, -area), from[k / 6], 1e-11);
        }
    ck_assert(curve_advance(&curve, 450, 0) == 450 && curve_advance(&curve, 100, 0) == 100);
}

TEST(one_point) {
    const struct curve flat = {x, y, 1};
    ck_assert(curve_advance(&flat, 500, 1600) == 502 && curve_advance(&flat, 500, -1600) == 498);
}

/* ---- files ------------------------------------------------------------------------------------------------------ */

static const struct curve_axes of_solid = {CURVE_AXIS_KELVINS, {"k lambda conductivity", "W/(m K)"}};
static const struct curve_axes of_emissivity = {CURVE_AXIS_KELVINS, {"e eps emissivity", ""}};

/* Reads a text as a table and keeps the messages. axes NULL: only a column of temperatures [K]. */
static int try_table(const char *text, const struct curve_axes *axes, struct curve *table) {
    write_file(text, strlen(text));
    begin_catching();
    const int status = axes ? curve_read(path, "value", axes, -300, 1e9, table)
                            : column_read(path, "temperature", &curve_kelvins.y, 0, 1e9, table);
    end_catching();
    return status;
}

/* However a table is written, it is 2 at 300 and 4 at 600. */
TEST(tables_of_one_meaning) {
    static const struct {
        const char *text;
        const struct curve_axes *axes;
    } cases[] = {
        {"300 2\n600 4\n", &of_solid},
        {"# of a book\n\n300,2\n600,4,\n", &of_solid},
        {"T,k\n300,2\n600,4\n", &of_solid},
        {"k,T\n2,300\n4,600\n", &of_solid},
        {"\"k [W/(m K)]\",\"T [K]\"\n2,300\n4,600\n", &of_solid},
        {"kappa,T\n2,300\n4,600\n", &of_solid},
        {"a (W/m/K);b (K)\n2;300\n4;600\n", &of_solid},
        {"T [C];k [W/(m K)]\n26,85;2\n326,85;4\n", &of_solid},
        {"T_C,k_s\n26.85,2\n326.85,4\n", &of_solid},
        {"T k [mW/(mm K)]\n300 2\n600 4\n", &of_solid},
        {"T,k [kW/(m K)]\n300,.002\n600,.004\n", &of_solid},
        {"rho,T,cp,lambda\n7,300,800,2\n7,600,900,4\n", &of_solid},
        {"# T [K], k\n# measured\n300 2\n600 4\n", &of_solid},
        {"# lambda T\n2 300\n4 600\n", &of_solid},
        {"Emissivity table\n300 2\n600 4\n", &of_emissivity},
        {"Emissivity,T\n2,300\n4,600\n", &of_emissivity},
        {"temperature_K emissivity_of_steel\n300 2\n600 4\n", &of_emissivity},
        {"t [min],T [K]\n5,2\n10,4\n", &curve_kelvins},
        {"T [C],t [s]\n2,300\n4,600\n", &curve_celsius},
        {"Time_min,Temperature\n5,2\n10,4\n", &curve_kelvins},
        {"time [ms]\theat [C]\n300000\t2\n600000\t4\n", &curve_celsius},
        {"T,t\n2,300\n4,600\n", &curve_kelvins},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        struct curve table;
        ck_assert_msg(try_table(cases[k].text, cases[k].axes, &table) == 0, "%s%s", cases[k].text, said);
        ck_assert_uint_eq(table.n, 2);
        for (int p = 0; p < 2; ++p) {
            ck_assert_msg(fabs(table.x[p] - 300 * (p + 1)) < 1e-10, "%s: x = %g", cases[k].text, table.x[p]);
            ck_assert_msg(fabs(table.y[p] - 2 * (p + 1)) < 1e-14, "%s: y = %g", cases[k].text, table.y[p]);
        }
        ck_assert_str_eq(said, "");
        curve_free(&table);
    }
}

TEST(tables_that_are_refused) {
    static const struct {
        const char *text, *reason;
        const struct curve_axes *axes;
        unsigned line;
    } cases[] = {
        {"t [min],T [C]\n0,20\n", "the column T is in [C], but is taken as [K]; see --temperature-unit", &curve_kelvins,
         1},
        {"\nt,T [K]\n0,20\n", "the column T is in [K], but is taken as [C]; see --temperature-unit", &curve_celsius, 2},
        {"t,T_C\n0,20\n", "the column T_C is in [C], but is taken as [K]", &curve_kelvins, 1},
        {"t [m],T [K]\n0,20\n", "the column t is in [m], but is taken as [s]", &curve_kelvins, 1},
        {"T,k [W/(m2 K)]\n300,2\n", "the column k is in [W/(m2 K)], but is taken as [W/(m K)]", &of_solid, 1},
        {"T,e [W]\n300,.5\n", "the column e is in [W], but is taken as [-]", &of_emissivity, 1},
        {"T,e,what\n300,.5\n", "2 columns instead of 3", &of_emissivity, 2},
        {"T,f,g\n300,.5,1\n", "3 columns instead of 2", &of_emissivity, 2},
        {"T,T\n300,300\n", NULL, &of_emissivity, 0},
        {"k,T\n2,300\n4,300\n", "300 is not above the number before", &of_solid, 3},
        {"T,k\n300,2\nx,y\n", "number is not a number: 'x'", &of_solid, 3},
        {"300;0,5\n400;0.5\n", "decimal commas and decimal points in one file", &of_solid, 2},
        {"T,k\n", "the table has no numbers", &of_solid, 0},
        {"T [C]\n20\n", "the column T is in [C], but is taken as [K]; see --temperature-unit", NULL, 1},
        {"300\n-1\n", "the temperature is -1; it must be within 0 and 1e+09", NULL, 2},
        {"a,b\n1,300\n", "2 columns instead of 1", NULL, 2},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        struct curve table;
        const int status = try_table(cases[k].text, cases[k].axes, &table);
        curve_free(&table);
        ck_assert_msg((status == STATUS_INPUT) == (cases[k].reason != NULL), "%s: %d %s", cases[k].text, status, said);
        if (!cases[k].reason) continue;
        assert_has(said, cases[k].reason);
        if (cases[k].line) assert_begins(said, formatted("fibrad: %s:%u: ", path, cases[k].line));
        ck_assert_ptr_eq(strchr(said, '\n'), said + strlen(said) - 1);
    }
    struct curve column;
    ck_assert_int_eq(try_table("triangle,T [K]\n1,300\n2,600\n", NULL, &column), 0);
    ck_assert(column.n == 2 && column.y[0] == 300 && column.y[1] == 600);
    curve_free(&column);
}

/* The factors are exact where powers of ten are. */
TEST(units) {
    static const struct {
        const char *name, *wanted;
        double factor; /* 0: of another kind */
    } cases[] = {{"kW", "W", 1e3},
                 {"mW", "W", 1e-3},
                 {"g/cm3", "kg/m3", 1e3},
                 {"kg m^-3", "kg/m3", 1},
                 {"W/m K", "W/(m K)", 1},
                 {"J/kgK", "J/(kg K)", 1},
                 {"W m", "W/(m K)", 0},
                 {"N m/s", "W", 1},
                 {"h", "s", 3600},
                 {"min", "s", 60},
                 {"kg m2/s3", "W", 1},
                 {"kg*m**2/s^3", "W", 1},
                 {"um", "m", 1e-6},
                 {"\302\265m", "m", 1e-6},
                 {"", "W", 0},
                 {"W/", "W", 1},
                 {"W//W", "1", 1},
                 {"W^", "W", 0},
                 {"W^100 W^-99", "W", 0},
                 {"/s", "1/s", 1},
                 {"((W))", "W", 1},
                 {"(W", "W", 0},
                 {"degC", "C", 1},
                 {"\302\260C", "C", 1},
                 {"\260C", "C", 1},
                 {"Kelvin", "K", 1},
                 {"C", "K", 0},
                 {"J/(kg \302\260C)", "J/(kg K)", 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        double factor = 0;
        const bool found = unit_factor(cases[k].name, cases[k].wanted, &factor);
        ck_assert_msg(found == (cases[k].factor > 0), "%s as %s", cases[k].name, cases[k].wanted);
        if (found) ck_assert_msg(factor == cases[k].factor, "%s as %s: %.17g", cases[k].name, cases[k].wanted, factor);
    }
    char longest[200];
    double factor;
    memset(longest, 'm', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    ck_assert(!unit_factor(longest, "m", &factor));
}
