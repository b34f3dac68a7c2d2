/* generate_pair_exact.c - makes the quadrature table of kernel/pair/exact.c and the table of true values of its
 * test. SPDX-License-Identifier: MIT
 *
 *     gcc generate_pair_exact.c -lquadmath -o generate && ./generate rule && ./generate values > pair_exact.csv
 *
 * Run by hand, in 113-bit arithmetic (gcc). `rule`: nodes y = sin^2 t, t = (pi/2)(e^5u - 1)/(e^5 - 1), u the nodes of
 * the 28-point Gauss-Legendre rule on [0, 1]; weights of the mean over the density (16/pi) sin^2 t cos^2 t dt.
 * `values`: the definition itself, F12 = (L(d) + integral of c(s) (1 - sqrt(1 - s^2/d^2)) ds) / (2 pi r1^2) over s from
 * |r1 - r2| to min(d, r1 + r2), L the lens area and c the chord of two shadow discs with centres s apart: tanh-sinh
 * quadrature in s^2/d^2 on panels graded towards its upper end, where the integrand nearly has a singularity. */
#include <quadmath.h>
#include <stdio.h>
#include <string.h>

typedef __float128 quad;

static void print(quad value, const char *format, const char *after) {
    char text[64];
    quadmath_snprintf(text, sizeof text, format, value);
    printf("%s%s", text, after);
}

static void rule(void) {
    enum { N = 28 };
    const quad a = 5;
    for (int i = N - 1; i >= 0; i--) {
        quad z = cosq(M_PIq * (i + 0.75Q) / (N + 0.5Q)), slope = 1;
        for (int step = 0; step < 60; step++) {
            quad p = 1, before = 0;
            for (int k = 0; k < N; k++) {
                quad next = ((2 * k + 1) * z * p - k * before) / (k + 1);
                before = p, p = next;
            }
            slope = N * (z * p - before) / (z * z - 1);
            z -= p / slope;
        }
        quad u = (1 + z) / 2, gauss = 1 / ((1 - z * z) * slope * slope);
        quad t = M_PI_2q * expm1q(a * u) / expm1q(a), dt = M_PI_2q * a * expq(a * u) / expm1q(a), y = sinq(t) * sinq(t);
        printf("    {");
        print(y, "%.17Qg", ", ");
        print(gauss * dt * 16 / M_PIq * y * (1 - y), "%.17Qg", "},\n");
    }
}

/* Squared lengths over d^2. The range of u = s^2 is [a, b]; p = 1 - b and w = 1 - a are formed from the gap. */
struct pair {
    quad a, p, w, q;
};

/* sqrt((b-u)(u-a))/(1 + sqrt(1-u)) at the distance `below` from a and `above` from the upper end (b, or d^2 if p <
 * 0). */
static quad integrand(const struct pair *g, quad below, quad above) {
    quad x = g->p > 0 ? g->p + above : above;    /* 1 - u */
    quad rest = g->p > 0 ? above : above - g->p; /* b - u */
    return sqrtq(rest * below) / (1 + sqrtq(x));
}

/* Tanh-sinh quadrature between two distances from the upper end, where `far` > `near`. */
static quad panel(const struct pair *g, quad whole, quad near, quad far) {
    const quad h = 1 / 64.0Q;
    quad sum = 0, length = far - near;
    for (int k = -300; k <= 300; k++) {
        quad s = M_PI_2q * sinhq(k * h), e = expq(-2 * fabsq(s)), small = e / (1 + e);
        quad from_near = length * (k < 0 ? small : 1 - small), from_far = length * (k < 0 ? 1 - small : small);
        quad above = near + from_near, below = (whole - far) + from_far;
        quad weight = h * M_PI_2q * coshq(k * h) * 2 * e / ((1 + e) * (1 + e)) * length;
        if (weight > 0) sum += weight * integrand(g, below, above);
    }
    return sum;
}

static quad lens(quad x, quad y, quad d) {
    quad big = x > y ? x : y, small = x > y ? y : x, cb = (d * d + big * big - small * small) / (2 * d * big);
    quad cs = (d * d + small * small - big * big) / (2 * d * small), tb = acosq(cb), ts = acosq(cs);
    return big * big * (tb - sinq(2 * tb) / 2) + small * small * (ts - sinq(2 * ts) / 2);
}

static quad view_factor(double r1, double r2, double gap) {
    quad x = r1, y = r2, d = x + y + gap, small = x < y ? x : y, big = x < y ? y : x;
    struct pair g = {.a = (x - y) * (x - y) / (d * d), .p = gap * (2 * (x + y) + gap) / (d * d)};
    g.w = (2 * small + gap) * (2 * big + gap) / (d * d), g.q = 4 * x * y / (d * d);
    quad whole = g.p > 0 ? g.q : g.w, split = fabsq(g.p), sum = 0, near = 0;
    /* Panels graded towards the upper end, whose inner length scale is |p|. */
    quad first = split > 0 && split < whole / 8 ? split : whole / 8;
    if (first < whole * 1e-24Q) first = whole * 1e-24Q;
    for (quad far = first; near < whole; near = far, far = far * 8 < whole / 8 ? far * 8 : whole)
        sum += panel(&g, whole, near, far);
    quad total = sum * d * d / 2;
    if (gap < 0) total += lens(x, y, d);
    return total / (2 * M_PIq * x * x);
}

static void values(void) {
    static const double ratio[] = {1, 0.9999999, 0.99, 0.8, 0.5, 0.25, 0.1, 0.01, 1e-3, 1e-4};
    static const double gap[] = {0,   1e-300, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1,
                                 0.3, 0.5,    1,     2,     4,    8,    30,   100,  1e3,  1e4,  1e6,  1e8,  1e12};
    static const double overlap[] = {1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.02, 0.05,
                                     0.1,   0.3,   0.5,  0.8,  1,    1.2,  1.5,  1.8,  1.95, 1.999};
    printf("r1,r2,gap,F12\n");
    for (unsigned i = 0; i < sizeof ratio / sizeof *ratio; i++) {
        for (unsigned k = 0; k < sizeof gap / sizeof *gap; k++) {
            printf("1,%.17g,%.17g,", ratio[i], gap[k]);
            print(view_factor(1, ratio[i], gap[k]), "%.25Qe", "\n");
            double near = gap[k] * ratio[i];
            if (ratio[i] < 1 && near > 0) {
                printf("1,%.17g,%.17g,", ratio[i], near);
                print(view_factor(1, ratio[i], near), "%.25Qe", "\n");
            }
        }
        for (unsigned k = 0; k < sizeof overlap / sizeof *overlap; k++) {
            double g = -overlap[k] * ratio[i];
            printf("1,%.17g,%.17g,", ratio[i], g);
            print(view_factor(1, ratio[i], g), "%.25Qe", "\n");
        }
    }
}

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "rule") == 0)
        rule();
    else if (argc == 2 && strcmp(argv[1], "values") == 0)
        values();
    else
        return 2;
    return 0;
}
