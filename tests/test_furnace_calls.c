/* test_furnace_calls.c - arguments, memory and the order of calls of a furnace. SPDX-License-Identifier: MIT */
#include "furnaces.h"

TEST(elementary_functions) {
    for (int k = 0; k < 200000; k++) {
        double x = -690 + 700.0 * k / 200000, u = (k + 0.5) / 200000, sine, cosine;
        ck_assert_double_le(fabs(fibrad_exp(x) - exp(x)), 4e-16 * exp(x));
        ck_assert_double_le(fabs(fibrad_log(u) - log(u)), 6e-16 * fabs(log(u)));
        fibrad_sincos_turn(u, &sine, &cosine);
        ck_assert_double_le(fabs(sine - sin(6.283185307179586 * u)), 2e-15);
        ck_assert_double_le(fabs(cosine - cos(6.283185307179586 * u)), 2e-15);
    }
    ck_assert_double_eq(fibrad_exp(-1000), 0);
    ck_assert_double_eq(fibrad_log(1), 0);
}

TEST(bad_configurations) {
    fibrad_furnace_config c = furnace_case(1);
    const struct {
        double *at, value;
    } bad[] = {{&c.size[1], 0},
               {&c.size[2], NAN},
               {&c.absorption, 0},
               {&c.absorption, -1},
               {&c.scattering, -.1},
               {&c.source, INFINITY},
               {&c.wall_temperature[3], 0},
               {&c.wall_emissivity[5], 1.01},
               {&c.wall_emissivity[0], NAN}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        const double was = *bad[k].at;
        *bad[k].at = bad[k].value;
        ck_assert_msg(fibrad_furnace_size(&c) == 0, "configuration %zu", k);
        *bad[k].at = was;
    }
    ck_assert_uint_gt(fibrad_furnace_size(&c), 0);
    ck_assert_uint_eq(fibrad_furnace_size(NULL), 0);
    for (uint32_t cells = 0; cells <= 1000000; cells += 1000000) {
        c.cells[0] = c.cells[1] = c.cells[2] = cells;
        ck_assert_uint_eq(fibrad_furnace_size(&c), 0);
    }
    c = furnace_case(1);
    memset(c.wall_emissivity, 0, sizeof c.wall_emissivity);
    ck_assert_uint_eq(fibrad_furnace_size(&c), 0);
}

TEST(memory) {
    fibrad_furnace_config config = coarse_case(1, 2);
    size_t size = fibrad_furnace_size(&config);
    OWNED unsigned char *block = allocate(size + 128);
    fibrad_furnace *furnace = NULL;
    memset(block, 0xa5, size + 128);
    ck_assert_int_eq(fibrad_furnace_init(&furnace, block, size - 1, &config), FIBRAD_E_SIZE);
    assert_invalid(fibrad_furnace_init(&furnace, NULL, size, &config));
    assert_invalid(fibrad_furnace_init(NULL, block, size, &config));
    assert_invalid(fibrad_furnace_init(&furnace, block, size, NULL));
    ck_assert_ptr_null(furnace);
    assert_ok(fibrad_furnace_init(&furnace, block, size, &config));

    size_t tally_size = fibrad_furnace_tally_size(furnace);
    OWNED unsigned char *tally_block = allocate(tally_size + 128);
    memset(tally_block, 0xa5, tally_size + 128);
    fibrad_furnace_tally *tally = NULL;
    ck_assert_uint_eq(fibrad_furnace_tally_size(NULL), 0);
    ck_assert_int_eq(fibrad_furnace_tally_init(&tally, tally_block, tally_size - 1, furnace), FIBRAD_E_SIZE);
    assert_invalid(fibrad_furnace_tally_init(&tally, tally_block, tally_size, NULL));
    ck_assert_ptr_null(tally);

    fibrad_furnace_report report;
    uint64_t planned;
    for (int physics = 0; physics < 2; physics++) {
        assert_ok(fibrad_furnace_tally_init(&tally, tally_block, tally_size, furnace));
        assert_ok(fibrad_furnace_emit(furnace, (fibrad_furnace_physics)physics, 3000, 1, &planned));
        assert_ok(fibrad_furnace_trace(furnace, tally, 0, planned));
    }
    assert_ok(fibrad_furnace_equilibrium(furnace, tally));
    assert_ok(fibrad_furnace_solve(furnace, FIBRAD_SCATTER_EXACT, 1e-6, 1000, &report));
    for (size_t k = 0; k < 128; k++) {
        ck_assert_uint_eq(block[size + k], 0xa5);
        ck_assert_uint_eq(tally_block[tally_size + k], 0xa5);
    }
}

static void emit(struct box *box, fibrad_furnace_physics physics, int restart) {
    assert_ok(fibrad_furnace_emit(box->furnace, physics, 2000, restart, &box->planned));
}

static int estimate(struct box *box, int tally) {
    return fibrad_furnace_estimate(box->furnace, box->tally[tally], FIBRAD_THETA_DEFINITION, 1, FIBRAD_SCATTER_EXACT);
}

/* Checks that the evaluation of its physics refuses the tally, and that all fields remain as they are. */
static void assert_refused(struct box *box, int tally, fibrad_furnace_physics physics) {
    double e[BOX_CELLS], flux[BOX_CELLS], theta[BOX_CELLS], power[6];
    memcpy(e, box->at.e, sizeof e);
    memcpy(flux, box->at.flux[2][0], sizeof flux);
    memcpy(theta, box->at.theta[2][0], sizeof theta);
    memcpy(power, box->at.power, sizeof power);
    int status = physics == FIBRAD_FURNACE_ATTENUATED ? estimate(box, tally) : equilibrium(box, tally);
    ck_assert_int_eq(status, FIBRAD_E_STATE);
    ck_assert_mem_eq(e, box->at.e, sizeof e);
    ck_assert_mem_eq(flux, box->at.flux[2][0], sizeof flux);
    ck_assert_mem_eq(theta, box->at.theta[2][0], sizeof theta);
    ck_assert_mem_eq(power, box->at.power, sizeof power);
}

TEST(bad_arguments) {
    const fibrad_furnace_config config = coarse_case(1, 4);
    OWNED_BOX box = make_box(&config);
    fibrad_furnace *furnace = box.furnace;
    fibrad_furnace_tally *tally = box.tally[0];
    fibrad_furnace_report report = {77, 7};
    uint64_t planned = 42;
    const fibrad_furnace_physics physics = FIBRAD_FURNACE_ATTENUATED, no_physics = (fibrad_furnace_physics)2;
    const fibrad_furnace_scatter exact = FIBRAD_SCATTER_EXACT, no_scatter = (fibrad_furnace_scatter)2;
    const fibrad_furnace_estimator no_estimator = (fibrad_furnace_estimator)2;
    assert_invalid(fibrad_furnace_theta(furnace, 0));
    assert_invalid(fibrad_furnace_theta(furnace, 1.01));
    assert_invalid(fibrad_furnace_theta(furnace, NAN));
    assert_invalid(fibrad_furnace_theta(NULL, 1));
    assert_invalid(fibrad_furnace_solve(furnace, exact, 0, 10, &report));
    assert_invalid(fibrad_furnace_solve(furnace, exact, NAN, 10, &report));
    assert_invalid(fibrad_furnace_solve(furnace, no_scatter, 1, 10, &report));
    assert_invalid(fibrad_furnace_solve(furnace, exact, 1, 10, NULL));
    assert_invalid(fibrad_furnace_solve(NULL, exact, 1, 10, &report));
    ck_assert_uint_eq(report.sweeps, 77);

    assert_invalid(fibrad_furnace_emit(NULL, physics, 10, 0, &planned));
    assert_invalid(fibrad_furnace_emit(furnace, physics, 10, 0, NULL));
    assert_invalid(fibrad_furnace_emit(furnace, physics, 0, 0, &planned));
    assert_invalid(fibrad_furnace_emit(furnace, physics, ((uint64_t)1 << 32) + 1, 0, &planned));
    assert_invalid(fibrad_furnace_emit(furnace, no_physics, 10, 0, &planned));
    ck_assert_uint_eq(planned, 42);

    emit(&box, physics, 1);
    assert_invalid(fibrad_furnace_trace(NULL, tally, 0, 1));
    assert_invalid(fibrad_furnace_trace(furnace, NULL, 0, 1));
    assert_invalid(trace(&box, 0, 0, box.planned + 1));
    assert_invalid(trace(&box, 0, box.planned, 1));
    assert_invalid(trace(&box, 0, box.planned + 1, 0));
    assert_invalid(trace(&box, 0, 1, UINT64_MAX));
    assert_invalid(trace(&box, 0, UINT64_MAX, 2));
    assert_invalid(fibrad_furnace_tally_add(NULL, tally));
    assert_invalid(fibrad_furnace_tally_add(tally, NULL));
    assert_invalid(fibrad_furnace_tally_add(tally, tally));
    assert_ok(trace(&box, 0, 0, box.planned)); /* none of this has changed anything */
    assert_invalid(fibrad_furnace_estimate(NULL, tally, FIBRAD_THETA_PAPER, 0, exact));
    assert_invalid(fibrad_furnace_estimate(furnace, NULL, FIBRAD_THETA_PAPER, 0, exact));
    assert_invalid(fibrad_furnace_estimate(furnace, tally, FIBRAD_THETA_PAPER, 1, exact));
    assert_invalid(fibrad_furnace_estimate(furnace, tally, no_estimator, 0, exact));
    assert_invalid(fibrad_furnace_estimate(furnace, tally, FIBRAD_THETA_PAPER, 0, no_scatter));
    assert_invalid(fibrad_furnace_equilibrium(NULL, tally));
    assert_invalid(fibrad_furnace_equilibrium(furnace, NULL));
    assert_ok(estimate(&box, 0));
    fibrad_furnace_fields(furnace, NULL);
}

TEST(no_plan) {
    const fibrad_furnace_config config = coarse_case(1, 4);
    const double wrong[] = {NAN, INFINITY, -INFINITY, 1e300, 1e25};
    OWNED_BOX box = make_box(&config);
    ck_assert_int_eq(trace(&box, 0, 0, 0), FIBRAD_E_STATE);
    ck_assert_int_eq(trace(&box, 0, 0, 1), FIBRAD_E_STATE);
    assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
    assert_refused(&box, 0, FIBRAD_FURNACE_EQUILIBRIUM);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        emit(&box, FIBRAD_FURNACE_ATTENUATED, 1);
        clear_tally(&box, 0);
        assert_ok(trace(&box, 0, 0, box.planned));
        const double before = box.at.e[3];
        const uint64_t plan = box.planned;
        box.at.e[3] = wrong[k];
        assert_invalid(fibrad_furnace_emit(box.furnace, FIBRAD_FURNACE_ATTENUATED, 2000, 0, &box.planned));
        ck_assert_uint_eq(box.planned, plan);
        box.at.e[3] = before;
        ck_assert_int_eq(trace(&box, 0, 0, 1), FIBRAD_E_STATE);
        assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
        emit(&box, FIBRAD_FURNACE_ATTENUATED, 0); /* this is a first plan, whether it is asked for or not */
        ck_assert_uint_eq(box.planned, plan);
        assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
    }
}

/* A tally is accepted if it has every bundle once, in any order and from any tallies. Anything else is refused. */
TEST(every_bundle_once) {
    /* each hundredth of the plan is traced once, except for these */
    static const struct {
        int missing[3], repeated[3];
    } wrong[] = {
        {{0, -1, -1}, {-1, -1, -1}},  {{99, -1, -1}, {-1, -1, -1}}, {{50, -1, -1}, {-1, -1, -1}},
        {{-1, -1, -1}, {0, -1, -1}},  {{-1, -1, -1}, {99, -1, -1}}, {{-1, -1, -1}, {7, 8, -1}},
        {{20, -1, -1}, {21, -1, -1}}, {{0, -1, -1}, {99, -1, -1}},  {{-1, -1, -1}, {5, 5, -1}},
        {{10, 14, 15}, {11, 12, 16}}, /* these are equal in number, sum and sum of squares */
    };
    const fibrad_furnace_config config = coarse_case(2, 4);
    for (int physics = 0; physics < 2; physics++) {
        OWNED_BOX box = make_box(&config);
        emit(&box, (fibrad_furnace_physics)physics, 1);
        assert_refused(&box, 0, (fibrad_furnace_physics)physics);
        for (size_t w = 0; w < 1 + sizeof wrong / sizeof *wrong; w++) {
            for (int k = 0; k < TALLIES; k++) clear_tally(&box, k);
            for (int part = 99; part >= 0; part--) {
                uint64_t first = box.planned * (uint64_t)part / 100, end = box.planned * (uint64_t)(part + 1) / 100;
                int times = 1;
                for (int k = 0; k < 3 && w > 0; k++)
                    times += (wrong[w - 1].repeated[k] == part) - (wrong[w - 1].missing[k] == part);
                for (int time = 0; time < times; time++)
                    assert_ok(trace(&box, (part + time) % TALLIES, first, end - first));
            }
            for (int k = 1; k < TALLIES; k++) assert_ok(fibrad_furnace_tally_add(box.tally[0], box.tally[k]));
            if (w > 0)
                assert_refused(&box, 0, (fibrad_furnace_physics)physics);
            else
                assert_ok(physics ? equilibrium(&box, 0) : estimate(&box, 0));
        }
    }
}

/* A tally is added to an equal one, so that it has all bundles twice. */
TEST(tallies_added_twice) {
    const fibrad_furnace_config config = coarse_case(2, 4);
    OWNED_BOX box = make_box(&config);
    emit(&box, FIBRAD_FURNACE_ATTENUATED, 1);
    assert_ok(trace(&box, 1, 0, box.planned));
    assert_ok(fibrad_furnace_tally_add(box.tally[0], box.tally[1]));
    assert_ok(fibrad_furnace_tally_add(box.tally[0], box.tally[2])); /* an empty one */
    assert_ok(estimate(&box, 0));
    assert_ok(estimate(&box, 1));
    assert_ok(fibrad_furnace_tally_add(box.tally[0], box.tally[1]));
    assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
    for (int k = 0; k < 300; k++) /* sums exceed 64 bits: they are refused, and not undefined */
        assert_ok(fibrad_furnace_tally_add(box.tally[k % 2], box.tally[1 - k % 2]));
    assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
}

TEST(further_plans) {
    const fibrad_furnace_config config = coarse_case(2, 4);
    OWNED_BOX box = make_box(&config);
    emit(&box, FIBRAD_FURNACE_ATTENUATED, 1);
    assert_ok(trace(&box, 0, 0, box.planned));
    assert_ok(estimate(&box, 0));
    for (size_t c = 0; c < BOX_CELLS; c++) box.at.e[c] *= 1 + 0.01 * (double)(c % 3);
    emit(&box, FIBRAD_FURNACE_ATTENUATED, 0);
    ck_assert_uint_gt(box.planned, 1);
    assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED); /* of the first plan only */
    assert_ok(trace(&box, 1, 0, box.planned));
    assert_refused(&box, 1, FIBRAD_FURNACE_ATTENUATED); /* of the second only */
    assert_ok(fibrad_furnace_tally_add(box.tally[0], box.tally[1]));
    assert_ok(estimate(&box, 0));

    emit(&box, FIBRAD_FURNACE_ATTENUATED, 0); /* E has not changed, so there is nothing to trace */
    ck_assert_uint_eq(box.planned, 0);
    assert_ok(trace(&box, 0, 0, 0));
    assert_ok(estimate(&box, 0));

    for (size_t c = 0; c < BOX_CELLS; c++) box.at.e[c] *= 1.01;
    emit(&box, FIBRAD_FURNACE_ATTENUATED, 0); /* all plans that follow lack the bundles of a plan that is not traced */
    emit(&box, FIBRAD_FURNACE_ATTENUATED, 0);
    ck_assert_uint_eq(box.planned, 0);
    assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
}

/* Tallies from before a restart are refused, whether the restart is asked for or follows from another physics. */
TEST(restarts) {
    const fibrad_furnace_config config = coarse_case(2, 4);
    for (int physics = 0; physics < 2; physics++) {
        OWNED_BOX box = make_box(&config);
        emit(&box, FIBRAD_FURNACE_ATTENUATED, 1);
        assert_ok(trace(&box, 0, 0, box.planned));
        ck_assert_int_eq(equilibrium(&box, 0), FIBRAD_E_STATE);
        assert_ok(estimate(&box, 0));
        emit(&box, (fibrad_furnace_physics)physics, physics == FIBRAD_FURNACE_ATTENUATED);
        assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
        assert_refused(&box, 0, FIBRAD_FURNACE_EQUILIBRIUM);
        ck_assert_int_eq(trace(&box, 0, 0, box.planned), FIBRAD_E_STATE);
        assert_ok(trace(&box, 1, 0, box.planned));
        ck_assert_int_eq(fibrad_furnace_tally_add(box.tally[0], box.tally[1]), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_furnace_tally_add(box.tally[1], box.tally[0]), FIBRAD_E_STATE);
        assert_ok(physics ? equilibrium(&box, 1) : estimate(&box, 1));
        assert_refused(&box, 1, (fibrad_furnace_physics)!physics);
    }
}

/* Tallies of other furnaces are refused: furnaces with other cells, and with the same cells but another seed, medium,
 * wall or E. */
TEST(other_furnaces) {
    for (int difference = 0; difference < 6; difference++) {
        fibrad_furnace_config config = coarse_case(2, 4), changed = config;
        if (difference == 0) changed.cells[2] = 7;
        if (difference == 1) changed.seed++;
        if (difference == 2) changed.absorption *= 1 + 1e-15;
        if (difference == 3) changed.wall_emissivity[0] -= 1e-15;
        if (difference == 4) changed.wall_temperature[5] += 1e-12;
        OWNED_BOX box = make_box(&config), other = make_box(&changed);
        if (difference == 5) other.at.e[7] *= 1 + 1e-15;
        emit(&box, FIBRAD_FURNACE_ATTENUATED, 1);
        emit(&other, FIBRAD_FURNACE_ATTENUATED, 1);
        assert_ok(trace(&other, 0, 0, other.planned));
        fibrad_furnace_tally *own = box.tally[0];
        box.tally[0] = other.tally[0];
        assert_refused(&box, 0, FIBRAD_FURNACE_ATTENUATED);
        ck_assert_int_eq(trace(&box, 0, 0, 1), FIBRAD_E_STATE);
        assert_ok(trace(&box, 1, 0, box.planned));
        ck_assert_int_eq(fibrad_furnace_tally_add(box.tally[1], box.tally[0]), FIBRAD_E_STATE);
        assert_ok(estimate(&box, 1)); /* what was refused has not changed it */
        assert_ok(estimate(&other, 0));
        box.tally[0] = own;
    }
}

/* Furnaces that are equal in everything have equal plans, so two processes may share the work. */
TEST(equal_furnaces) {
    const fibrad_furnace_config config = coarse_case(2, 4);
    OWNED_BOX one = make_box(&config), two = make_box(&config);
    emit(&one, FIBRAD_FURNACE_ATTENUATED, 1);
    emit(&two, FIBRAD_FURNACE_ATTENUATED, 1);
    assert_ok(trace(&one, 0, 0, 500));
    assert_ok(trace(&two, 0, 500, two.planned - 500));
    assert_ok(fibrad_furnace_tally_add(one.tally[0], two.tally[0]));
    assert_ok(estimate(&one, 0));
    assert_ok(trace(&two, 0, 0, 500));
    assert_ok(estimate(&two, 0));
    ck_assert_mem_eq(one.at.theta[0][0], two.at.theta[0][0], BOX_CELLS * sizeof(double));
}

/* The walls have one temperature, there is no source, and E is that of the walls. So there are no bundles, and an empty
 * tally is complete. */
TEST(nothing_to_trace) {
    fibrad_furnace_config config = coarse_case(2, 4);
    config.source = 0;
    for (int w = 0; w < 6; w++) config.wall_temperature[w] = 900;
    OWNED_BOX box = make_box(&config);
    for (size_t c = 0; c < BOX_CELLS; c++) box.at.e[c] = SIGMA * 900 * 900 * (900.0 * 900);
    for (int physics = 0; physics < 2; physics++) {
        emit(&box, (fibrad_furnace_physics)physics, 1);
        assert_ok(physics ? equilibrium(&box, 0) : estimate(&box, 0));
        ck_assert_double_eq_tol(fibrad_furnace_temperature(box.at.e[5]), 900, 1e-9);
    }
}

/* What the caller may write is refused if it is NaN or infinite, wherever it stands. This holds also in a solved field,
 * where all other cells have converged. */
TEST(solve_refuses_nan) {
    const fibrad_furnace_config config = coarse_case(2, 4);
    const double wrong[] = {NAN, INFINITY, -INFINITY};
    fibrad_furnace_report report;
    for (size_t k = 0; k < BOX_CELLS; k++) {
        for (int field = 0; field < 4; field++) {
            OWNED_BOX box = make_box(&config);
            assert_ok(fibrad_furnace_solve(box.furnace, FIBRAD_SCATTER_SIX_FLUX, 1e-5, 1000, &report));
            const fibrad_furnace_report before = report;
            const size_t layers = k + BOX_CELLS / 8; /* the upper face of the cell */
            if (field == 0) box.at.e[k] = wrong[k % 3];
            if (field == 1) box.at.theta[2][0][layers] = NAN;
            if (field == 2) box.at.theta[2][1][k] = NAN;
            if (field == 3) box.at.transverse[2][k % 2][k] = NAN;
            assert_invalid(fibrad_furnace_solve(box.furnace, FIBRAD_SCATTER_SIX_FLUX, 1, 1000, &report));
            ck_assert_mem_eq(&before, &report, sizeof report);
        }
    }
}
