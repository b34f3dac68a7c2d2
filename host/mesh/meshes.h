/* meshes.h - walls of triangles from files, in the form of the library. SPDX-License-Identifier: MIT */
#ifndef MESHES_H
#define MESHES_H

#include "fibrad_mesh.h"
#include "mesh/welded.h"

/* ---- values of the sides of triangles, and arrays over triangles made of them ------------------------------------ */

/* Makes the value of a triangle of the values of its two sides: their sum, or the temperature whose T^4 is the mean. */
typedef double side_join(double a, double b);
side_join sum_of_sides, mean_of_sides;

/* The value of a triangle. NaN: the side has no value, and that of the other side counts. */
double side_joined(const double side[2], side_join *join);

/* One quantity. NaN: the side has no value. */
struct side_quantity {
    const char *name[3]; /* names of the arrays of whole triangles, of fronts and of backs */
    side_join *join;
    double *side;     /* [2 n] in: element 2 t is the front and 2 t + 1 the back of triangle t */
    double *shown[3]; /* [n] out: the three arrays */
};

/* Begin with zeroes; free with side_arrays_free. */
enum { SIDE_QUANTITIES = 2 };
struct side_arrays {
    uint32_t n;    /* triangles */
    size_t arrays; /* per quantity: 3 if both sides of some triangle are walls, else 1 */
    size_t count;  /* of quantities */
    struct side_quantity quantity[SIDE_QUANTITIES];
    double *values; /* the block of all arrays */
};

/* Allocates the arrays of quantities [count]. Status 0 or STATUS_MEMORY. */
int side_arrays_begin(struct side_arrays *arrays, const struct fibrad_triangles *triangles,
                      const struct side_quantity *quantity, size_t count);
void side_arrays_free(struct side_arrays *arrays);

/* Fills `shown` from `side`. */
void side_arrays_show(struct side_arrays *arrays);

/* ---- walls of triangles from files, in the form of the library --------------------------------------------------- */

enum { MESH_NAME = 32 };

/* Which sides of triangles are the wall: those where the spheres are, the fronts by the winding of the file, or both.
 */
enum mesh_sides { SIDES_AUTO, SIDES_NORMALS, SIDES_BOTH };

/* A file of --wall. */
struct mesh_file {
    const char *path;
    const char *name; /* name of the wall, or the first part of the names of its solids; NULL: from the path */
    enum mesh_sides sides;
    bool solids;  /* each solid is a wall */
    double scale; /* > 0 */
};

struct mesh {
    char *file;
    bool text;
    enum mesh_sides sides;
    uint32_t first; /* its first triangle among those of all meshes */
    uint32_t wall;  /* its first wall */
    uint32_t walls; /* its number of walls: 1, or one per solid */
    struct surface surface;
};

/* All meshes of a run. Begin with zeroes; free with meshes_free. */
struct meshes {
    uint32_t count;
    struct mesh *mesh;
    char name[FIBRAD_WALLS_MAX][MESH_NAME]; /* names of the walls that are meshes */
    struct fibrad_triangles triangles;      /* of all meshes, with the sides of the last meshes_face */
    uint32_t enclosing;                     /* closed components whose inner side alone is a wall, by meshes_face */
    /* arrays of `triangles` */
    double *vertex;
    uint32_t *corner, *front, *back;
};

/* Whether a name is valid for a wall: 1 to 31 letters, digits and _. */
bool mesh_name(const char *name);

/* Adds the mesh of a file. Its first wall gets the index `wall`. Warns of faults of the mesh. Status 0, STATUS_USAGE if
 * there are too many walls, or as stl_read. */
int meshes_add(struct meshes *meshes, const struct mesh_file *file, uint32_t wall);

/* Adds a mesh of triangles in memory, as if the file had them. The caller keeps `stl`. */
int meshes_take(struct meshes *meshes, const struct mesh_file *file, const struct stl *stl, uint32_t wall);

/* Finds which sides of triangles are walls, for these spheres; sets `inner` of all components. Status 0 or
 * STATUS_MEMORY. */
int meshes_face(struct meshes *meshes, const fibrad_spheres *spheres, const double period[3]);

/* For a triangle of a closed component with a wall on one side only: 1 if this side is the wall, -1 if the other side
 * is. 0: any other triangle. */
int meshes_side(const struct meshes *meshes, uint32_t triangle, bool back);

/* A sphere may lie wholly behind the wall of a closed component that has a wall on one side only. Returns the name of
 * this wall. NULL: there is none. Cost: all triangles are looked at. */
const char *meshes_beyond(const struct meshes *meshes, const double centre[3], double r, const double period[3]);

/* The mesh of a triangle or of a wall. NULL: there is none. */
const struct mesh *mesh_of_triangle(const struct meshes *meshes, uint32_t triangle);
const struct mesh *mesh_of_wall(const struct meshes *meshes, uint32_t wall);

/* The wall of triangle `own` of a mesh, counted within the mesh. */
uint32_t mesh_wall(const struct mesh *mesh, uint32_t own);

/* The number of triangles of a wall. */
uint32_t mesh_triangles(const struct mesh *mesh, uint32_t wall);

/* The least and largest coordinates of a wall. */
void mesh_extents(const struct meshes *meshes, uint32_t wall, double low[3], double high[3]);

/* Prints why the library refuses a triangle, of a bed that also has planes or not. Returns STATUS_INPUT. */
int meshes_refuse(const struct meshes *meshes, int status, uint32_t triangle, bool planes);

void meshes_free(struct meshes *meshes);

#endif
