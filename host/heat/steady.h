/* steady.h - effective conductivity of a bed between two plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT */
#ifndef STEADY_H
#define STEADY_H

#include "bed/conductivity.h"
#include "contact_options/contact_option.h"

/* Temperatures of the plates over their mean. They differ so little that conductivities are the same everywhere. */
#define STEADY_HOT  1.0005
#define STEADY_COLD 0.9995

enum { STEADY_DIRECTIONS = 400 };

/* Exchange factor F_E along one axis: flux / (mean diameter x gradient of sigma T^4). The gradient is that of a
 * straight line through the spheres of the inner half. */
struct steady {
    double factor;
    double error;     /* estimated, of the line, of the flux and of the directions together */
    uint32_t spheres; /* in the inner half */
    double seconds;   /* time of computing [s] */
};

/* Whether the bed is periodic along both other axes, or ends at walls there. walls NULL: none. */
bool steady_possible(const struct bed *bed, const struct walls *walls, int axis);

/* Puts black plates at both ends of the bed along an axis, whose period is dropped. Sides (walls) are insulated. Then
 * finds the temperatures at which no sphere gains or loses heat. emissivity [spheres]. relative [spheres]: k* of
 * spheres that conduct, solved by patches; NULL: each sphere has one temperature. Status 0, STATUS_INPUT if fewer than
 * 40 spheres lie in the inner half, or as bed_options_status. */
int steady_conduction(struct bed_options *options, const struct bed *bed, const struct walls *walls,
                      const double *emissivity, const double *relative, int axis, struct steady *steady);

/* The lower and the upper plate at the ends of a bed, and then the sides. sides NULL: none. */
struct walls steady_walls(const struct bed *bed, const struct walls *sides, int axis);

/* The area of the bed across an axis. */
double steady_area(const struct bed *bed, const struct walls *sides, int axis);

/* A straight line through values of the spheres of the inner half between two plates. */
struct steady_line {
    double slope, error; /* of the slope */
    uint32_t spheres;
};

/* Fits such a line to values [n], NaN: left out, against the place along the axis in a unit. Both arrays [n] are
 * changed. file: name of the bed in messages. Status 0, or STATUS_INPUT if there are too few spheres. */
int steady_fit(const struct bed *bed, const char *file, int axis, const struct walls *plates, double unit,
               double *values, double *place, struct steady_line *line);

/* What conducts in a bed. */
struct total_problem {
    const struct contact_options *contacts;
    const struct quantity *solid;   /* --solid-conductivity */
    const double *emissivity;       /* [spheres] */
    const double *relative;         /* [spheres] k* of spheres that conduct; NULL: each sphere has one temperature */
    const struct walls *sides;      /* insulated, in contact with nothing */
    double temperature;             /* [K] */
    double diameter;                /* mean diameter [L] */
    struct conduction_value linear; /* by radiation if temperatures of spheres are linear */
};

/* As steady_conduction, with contacts. If the bed is periodic along the axis by at least 4 mean diameters and 3 largest
 * ones, and each sphere has one temperature, all temperatures rise by the same amount from one period to the next. Else
 * spheres within a diameter of a plate have its temperature, and those of the plates differ by a thousandth. Status as
 * steady_conduction and contacts_begin. */
int steady_contacts(struct bed_options *options, const struct bed *bed, const struct total_problem *problem, int axis,
                    struct conduction_total *total);

#endif
