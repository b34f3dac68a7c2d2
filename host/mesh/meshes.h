/* meshes.h - walls of triangles from files, as the library takes them. SPDX-License-Identifier: MIT */
#ifndef MESHES_H
#define MESHES_H

#include "fibrad_mesh.h"
#include "mesh/side_arrays.h"
#include "mesh/welded.h"

enum { MESH_NAME = 32 };

/* Which sides of triangles are the body: those that spheres are on, those that the file calls outer ones, both. */
enum mesh_sides { SIDES_AUTO, SIDES_NORMALS, SIDES_BOTH };

/* A file that is wanted. */
struct mesh_file {
    const char *path;
    const char *name; /* of the body, or before that of each solid, valid as mesh_name says; NULL: after the file */
    enum mesh_sides sides;
    bool solids;  /* a body each */
    double scale; /* > 0 */
};

struct mesh {
    char *file;
    bool text;
    enum mesh_sides sides;
    uint32_t first;  /* of its triangles among all */
    uint32_t body;   /* its first one */
    uint32_t bodies; /* that many, of its solids in turn */
    struct surface surface;
};

/* All meshes of a run. Zeroed: none; to be freed by meshes_free. */
struct meshes {
    uint32_t count;
    struct mesh *mesh;
    char name[FIBRAD_BODIES_MAX][MESH_NAME]; /* of bodies that are meshes */
    struct fibrad_triangles triangles;       /* all of them; sides are those of the last meshes_face */
    uint32_t enclosing;                      /* parts that are closed and whose inner sides alone are walls, then */
    /* what `triangles` has */
    double *vertex;
    uint32_t *corner, *front, *back;
};

/* Whether a body may be called so: letters, digits and _, at most 31. */
bool mesh_name(const char *name);

/* Reads a file, whose bodies are `body` and those behind it; warns of what is not sound. Status 0; STATUS_USAGE: too
 * many bodies; as stl_read. */
int meshes_add(struct meshes *meshes, const struct mesh_file *file, uint32_t body);

/* The same with triangles that are there, as if the file had them. Those stay the caller's. */
int meshes_take(struct meshes *meshes, const struct mesh_file *file, const struct stl *stl, uint32_t body);

/* Finds out which sides these spheres are on. Status 0 or STATUS_MEMORY. */
int meshes_face(struct meshes *meshes, const fibrad_spheres *spheres, const double period[3]);

/* How many parts are closed, with one side that is a body, and it is the inner one. Sets part.inner of all: 1 if of a
 * closed part the fronts of triangles that are not turned and the backs of the others are bodies, -1 if it is their
 * other sides, else 0. */
uint32_t meshes_enclosing(struct meshes *meshes);

/* 1 if this side of a triangle is a body's, of a closed part that has one such side, -1 if it is the other one of such
 * a part, else 0. */
int meshes_side(const struct meshes *meshes, uint32_t triangle, bool back);

/* The name of the body, of a closed part with one such side, beyond which a sphere lies with all of it; NULL: there is
 * none. Cost: a look at each triangle. */
const char *meshes_beyond(const struct meshes *meshes, const double centre[3], double r, const double period[3]);

/* The mesh of a triangle or body; NULL: it is of none. */
const struct mesh *mesh_of_triangle(const struct meshes *meshes, uint32_t triangle);
const struct mesh *mesh_of_body(const struct meshes *meshes, uint32_t body);

/* The body of a triangle of a mesh, which is triangle `own` there. */
uint32_t mesh_body(const struct mesh *mesh, uint32_t own);

/* Triangles of a body. */
uint32_t mesh_triangles(const struct mesh *mesh, uint32_t body);

/* The lower and upper ends of a body along each axis. */
void mesh_extents(const struct meshes *meshes, uint32_t body, double low[3], double high[3]);

/* Says that the library refuses a triangle. Returns STATUS_INPUT. */
int meshes_refuse(const struct meshes *meshes, int status, uint32_t triangle);

void meshes_free(struct meshes *meshes);

#endif
