/* meshes.h - walls of triangles from files, as the library takes them. SPDX-License-Identifier: MIT */
#ifndef MESHES_H
#define MESHES_H

#include "fibrad_mesh.h"
#include "mesh/surface.h"

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
    bool enclose;                            /* spheres of that lie in one that is closed */
    /* what `triangles` has */
    double *vertex;
    uint32_t *corner, *front, *back;
};

/* Whether a body may be called so: letters, digits and _, at most 31. */
bool mesh_name(const char *name);

/* Reads a file, whose bodies are `body` and those behind it; warns of what is not sound. Status 0; STATUS_USAGE: too
 * many bodies; as stl_read. */
int meshes_add(struct meshes *meshes, const struct mesh_file *file, uint32_t body);

/* Finds out which sides these spheres are on. Status 0 or STATUS_MEMORY. */
int meshes_face(struct meshes *meshes, const fibrad_spheres *spheres, const double period[3]);

/* The mesh of a triangle or body; NULL: it is of none. */
const struct mesh *mesh_of_triangle(const struct meshes *meshes, uint32_t triangle);
const struct mesh *mesh_of_body(const struct meshes *meshes, uint32_t body);

/* The body of a triangle of a mesh, which is triangle `own` there. */
uint32_t mesh_body(const struct mesh *mesh, uint32_t own);

/* Triangles of a body. */
uint32_t mesh_triangles(const struct mesh *mesh, uint32_t body);

/* Says that the library refuses a triangle. Returns STATUS_INPUT. */
int meshes_refuse(const struct meshes *meshes, int status, uint32_t triangle);

void meshes_free(struct meshes *meshes);

#endif
