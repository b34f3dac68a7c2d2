/* scene_build.c - copies spheres into a fixed-memory cell grid, and checks them. SPDX-License-Identifier: MIT */
#include "base/random.h"
#include "base/dispatch.h"
#include "scene/clumps.h"
#include "scene/grid_walk.h"
#include "scene/surroundings.h"
#include "scene/walls.h"

/* Average number of spheres in a cell, of the level of the cell. */
#define SPHERES_PER_CELL 2.0
/* The number of cells of a level is at most the number of its spheres and this number. */
#define SPARE_CELLS 8u

static fibrad_scene *scene_layout(fibrad_arena *arena, uint32_t n, bool ids, uint32_t triangles, bool clumps) {
    fibrad_scene *scene = fibrad_arena_take(arena, 1, sizeof *scene);
    double *x = fibrad_arena_take(arena, n, sizeof *x), *y = fibrad_arena_take(arena, n, sizeof *y);
    double *z = fibrad_arena_take(arena, n, sizeof *z), *r = fibrad_arena_take(arena, n, sizeof *r);
    fibrad_coarse *coarse = fibrad_arena_take(arena, ((size_t)n + FIBRAD_COARSE - 1) / FIBRAD_COARSE, sizeof *coarse);
    uint32_t *order = fibrad_arena_take(arena, n, sizeof *order), *place = fibrad_arena_take(arena, n, sizeof *place);
    uint32_t *start = fibrad_arena_take(arena, (size_t)n + FIBRAD_LEVELS * SPARE_CELLS + 1, sizeof *start);
    uint64_t *id = ids ? fibrad_arena_take(arena, n, sizeof *id) : NULL;
    unsigned char *cut = fibrad_arena_take(arena, n, sizeof *cut);
    fibrad_mesh mesh = {0};
    if (triangles > 0) fibrad_mesh_layout(arena, &mesh, triangles);
    float *clear = triangles > 0 ? fibrad_arena_take(arena, n, sizeof *clear) : NULL;
    uint32_t *clump = clumps ? fibrad_arena_take(arena, n, sizeof *clump) : NULL;
    fibrad_clumps of_clumps = {0};
    if (clumps) fibrad_clumps_layout(arena, n, &of_clumps);
    if (arena->base != NULL) {
        fibrad_zero(scene, sizeof *scene);
        scene->x = x, scene->y = y, scene->z = z, scene->r = r, scene->coarse = coarse;
        scene->order = order, scene->place = place, scene->start = start, scene->id = id;
        scene->cut = cut, scene->mesh = mesh, scene->clear = clear, scene->clump = clump, scene->clumps = of_clumps;
    }
    return scene;
}

/* Whether a scene can be made for a configuration. Errors: FIBRAD_E_ARGUMENT, _UNSUPPORTED, _ENDLESS, _ISA. */
static int check_config(const fibrad_scene_config *config) {
    for (int axis = 0; axis < 3; axis++)
        if (!(config->period[axis] >= 0 && fibrad_finite(config->period[axis]))) return FIBRAD_E_ARGUMENT;
    int status = fibrad_surroundings_check(config);
    if (status == FIBRAD_OK) status = fibrad_walls_check(config);
    if (status != FIBRAD_OK) return status;
    const int isa = fibrad_isa_choose(config->isa);
    return isa == -2 ? FIBRAD_E_ARGUMENT : isa == -1 ? FIBRAD_E_ISA : FIBRAD_OK;
}

size_t fibrad_scene_size(uint32_t n, int ids) {
    if (n > FIBRAD_SPHERES_MAX) return 0;
    fibrad_arena arena = {0};
    scene_layout(&arena, n, ids != 0, 0, false);
    return fibrad_arena_total(&arena);
}

size_t fibrad_clumps_size(uint32_t n) {
    const size_t without = fibrad_scene_size(n, 0);
    fibrad_arena arena = {0};
    if (without == 0) return 0;
    scene_layout(&arena, n, false, 0, true);
    return fibrad_arena_total(&arena) - without;
}

static int scene_fault(int status, fibrad_fault *fault, uint32_t first, uint32_t second) {
    if (fault != NULL) *fault = (fibrad_fault){first, second, UINT32_MAX, 0, 0};
    return status;
}

static int sphere_fault(fibrad_fault *fault, uint32_t sphere, int why) {
    if (fault != NULL) *fault = (fibrad_fault){sphere, sphere, UINT32_MAX, 0, why};
    return FIBRAD_E_ARGUMENT;
}

/* If walls are the reason for the status: the first wall that contradicts the box or the walls before it. */
static void wall_fault(int status, fibrad_fault *fault, uint32_t n, const fibrad_scene_config *config) {
    fibrad_scene_config some = *config;
    uint32_t wall = 0;
    if (status == FIBRAD_E_ARGUMENT && config->wall != NULL && config->walls <= FIBRAD_WALLS_MAX)
        for (some.walls = 1; some.walls <= config->walls && wall == 0; some.walls++)
            if (fibrad_walls_check(&some) == FIBRAD_E_ARGUMENT) wall = some.walls;
    if (fault != NULL) *fault = (fibrad_fault){n, n, UINT32_MAX, wall, wall > 0 ? FIBRAD_WHY_WALL : 0};
}

/* The caller's arrays, with strides of 0 replaced by 1. */
static fibrad_spheres with_strides(const fibrad_spheres *spheres) {
    fibrad_spheres s = *spheres;
    if (s.stride == 0) s.stride = 1;
    if (s.stride_r == 0) s.stride_r = 1;
    return s;
}

static double coordinate_of(const fibrad_spheres *s, int axis, uint32_t i) {
    return (axis == 0 ? s->x : axis == 1 ? s->y : s->z)[(size_t)i * s->stride];
}

static double radius_of(const fibrad_spheres *s, uint32_t i) { return s->r[(size_t)i * s->stride_r]; }

/* Narrows [low, high] to the place of most coordinates: their mean and four standard deviations on both sides. This
 * is repeated as long as it excludes coordinates. A particle that was lost far away must not make cells larger. Such
 * a particle goes into the outermost cell. */
static void trim(const fibrad_spheres *s, int axis, double *low, double *high) {
    const uint32_t n = s->n;
    for (int round = 0; round < 16; round++) {
        double sum = 0, square = 0, middle = *low + (*high - *low) / 2, half = (*high - *low) / 2;
        uint32_t within = 0;
        if (half == 0) return;
        for (uint32_t i = 0; i < n; i++) {
            double d = (coordinate_of(s, axis, i) - middle) / half;
            if (!(fibrad_abs(d) <= 1)) continue;
            sum += d, square += d * d;
            within++;
        }
        if (within == 0) return; /* all coordinates lie at the ends, and rounding has excluded both */
        double mean = sum / within, spread = 4 * fibrad_sqrt(fibrad_max(0, square / within - mean * mean));
        double from = fibrad_max(-1, mean - spread), to = fibrad_min(1, mean + spread);
        if (from == -1 && to == 1) return;
        *low = middle + half * from, *high = middle + half * to;
    }
}

/* A hash of all that a scene is made from. Two scenes that differ have the same hash in one case of 2^64. Never 0. */
static uint64_t hash_of(const fibrad_scene *scene, const fibrad_spheres *s) {
    const fibrad_container *c = &scene->container;
    const fibrad_occupancy *o = &scene->occupancy;
    uint64_t hash = fibrad_mix(s->n), cells = 1;
    for (int axis = 0; axis < 3; axis++) {
        const double fixed[] = {scene->period[axis],
                                c->low[axis],
                                c->high[axis],
                                o->low[axis],
                                o->high[axis],
                                scene->mesh.period[axis],
                                axis < 2 ? c->axis[axis] : c->radius};
        for (size_t k = 0; k < sizeof fixed / sizeof *fixed; k++) hash = fibrad_hash_number(hash, fixed[k]);
        hash = fibrad_hash_word(hash, 2 * (uint64_t)o->cells[axis] + (uint64_t)o->periodic[axis]);
        cells *= o->cells[axis];
    }
    for (uint64_t k = 0; o->mark != NULL && k < (cells + 63) / 64; k++) hash = fibrad_hash_word(hash, o->mark[k]);
    hash = fibrad_hash_word(hash, (uint64_t)c->turn << 32 | (uint64_t)c->openings << 1 | (o->mark != NULL));
    for (uint32_t b = 0; b < scene->facts.walls; b++) hash = fibrad_hash_word(hash, scene->slot[b]);
    for (uint32_t i = 0; i < s->n; i++) {
        for (int axis = 0; axis < 3; axis++) hash = fibrad_hash_number(hash, coordinate_of(s, axis, i));
        hash = fibrad_hash_number(hash, radius_of(s, i));
        if (s->id != NULL) hash = fibrad_hash_word(hash, s->id[i]);
        if (scene->clump != NULL) hash = fibrad_hash_word(hash, s->clump[i]);
    }
    for (uint32_t t = 0; t < scene->mesh.triangles; t++) {
        for (int k = 0; k < 9; k++) hash = fibrad_hash_number(hash, scene->mesh.corner[k / 3][k % 3][t]);
        hash = fibrad_hash_word(hash, scene->mesh.mesh[t][0] + 256u * scene->mesh.mesh[t][1]);
    }
    return fibrad_mix(hash) | 1;
}

/* The greatest coordinate or period that is allowed. */
static double longest_among(const fibrad_scene *scene) {
    if (scene->facts.spheres == 0) return FIBRAD_LENGTH_MAX;
    return fibrad_min(FIBRAD_LENGTH_MAX, FIBRAD_COORDINATE_MAX * scene->facts.radius_min);
}

/* Finds the box of the centres and the range of the radii. A centre on a periodic axis is moved into [low, low +
 * period), where low is the least coordinate. So a bed that fits its box keeps its coordinates to the bit. */
static int measure_spheres(fibrad_scene *scene, const fibrad_spheres *s, fibrad_fault *fault) {
    scene->facts.radius_min = scene->facts.radius_max = s->n > 0 ? radius_of(s, 0) : 0;
    for (uint32_t i = 0; i < s->n; i++) {
        for (int axis = 0; axis < 3; axis++) {
            double c = coordinate_of(s, axis, i);
            if (!(fibrad_abs(c) <= FIBRAD_LENGTH_MAX)) return sphere_fault(fault, i, FIBRAD_WHY_PLACE);
            if (i == 0 || c < scene->low[axis]) scene->low[axis] = c;
            if (i == 0 || c > scene->high[axis]) scene->high[axis] = c;
        }
        const double r = radius_of(s, i);
        if (!(r >= FIBRAD_LENGTH_MIN && r <= FIBRAD_LENGTH_MAX)) return sphere_fault(fault, i, FIBRAD_WHY_RADIUS);
        scene->facts.radius_min = fibrad_min(scene->facts.radius_min, r);
        scene->facts.radius_max = fibrad_max(scene->facts.radius_max, r);
    }
    const double longest = longest_among(scene);
    for (uint32_t i = 0; i < s->n; i++) {
        for (int axis = 0; axis < 3; axis++)
            if (fibrad_abs(coordinate_of(s, axis, i)) > longest) return sphere_fault(fault, i, FIBRAD_WHY_PLACE);
        const double centre[3] = {coordinate_of(s, 0, i), coordinate_of(s, 1, i), coordinate_of(s, 2, i)};
        if (!fibrad_walls_hold_ball(&scene->container, centre, radius_of(s, i)))
            return scene_fault(FIBRAD_E_GEOMETRY, fault, i, i);
        scene->container.cuts = scene->container.cuts || fibrad_walls_cut(&scene->container, centre, radius_of(s, i));
        if (!fibrad_walls_hold(&scene->container, centre)) return sphere_fault(fault, i, FIBRAD_WHY_BEYOND);
    }
    if (fibrad_walls_reach(&scene->container) > longest) return scene_fault(FIBRAD_E_ARGUMENT, fault, s->n, s->n);
    for (int axis = 0; axis < 3; axis++)
        if (scene->period[axis] > longest) return scene_fault(FIBRAD_E_ARGUMENT, fault, s->n, s->n);
    for (int axis = 0; axis < 3; axis++) {
        scene->box_low[axis] = scene->low[axis], scene->box_high[axis] = scene->high[axis];
        if (scene->period[axis] > 0)
            scene->high[axis] = scene->box_high[axis] = scene->low[axis] + scene->period[axis];
        else
            trim(s, axis, &scene->box_low[axis], &scene->box_high[axis]);
    }
    return FIBRAD_OK;
}

static double wrapped(double c, double low, double period) {
    if (period == 0 || (c - low >= 0 && c - low < period)) return c;
    double inside = c - period * fibrad_floor((c - low) / period);
    return inside >= low && inside - low < period ? inside : low; /* the quotient may be rounded up */
}

static uint32_t level_of(double r, double radius_min) {
    uint32_t level = 0;
    for (double bound = 2 * radius_min; r >= bound && level < FIBRAD_LEVELS - 1; bound *= 2) level++;
    return level;
}

/* The cube root of v by Newton's iteration, which begins at 1. Accurate enough for a length scale. */
static double cube_root(double v) {
    double root = 1;
    for (int i = 0; i < 200 && root * root * root > 1.01 * v; i++) root -= (root - v / (root * root)) / 3;
    return root;
}

/* Length of the box of the grid along an axis. */
static double side(const fibrad_scene *scene, int axis) {
    return scene->period[axis] > 0 ? scene->period[axis] : scene->box_high[axis] - scene->box_low[axis];
}

/* Chooses the cells of a level of `count` spheres. The cells are as near to cubes as the box allows and hold
 * SPHERES_PER_CELL spheres on average. Their number is bounded, see SPARE_CELLS. */
static uint32_t choose_cells(const fibrad_scene *scene, fibrad_level *level, uint32_t count) {
    double extent[3], longest = 0, volume = 1;
    for (int axis = 0; axis < 3; axis++) {
        extent[axis] = side(scene, axis);
        if (scene->period[axis] == 0) extent[axis] += 2 * level->radius_max;
        longest = fibrad_max(longest, extent[axis]);
    }
    for (int axis = 0; axis < 3; axis++) volume *= extent[axis] / longest;
    double cell = longest * cube_root(fibrad_min(1, volume * (SPHERES_PER_CELL / count))), total;
    do {
        total = 1;
        for (int axis = 0; axis < 3; axis++) {
            double cells = fibrad_max(1, fibrad_floor(fibrad_min(extent[axis] / cell, 1e6)));
            level->cells[axis] = (int32_t)cells;
            level->cell[axis] = extent[axis] / cells;
            level->inverse[axis] = cells / extent[axis];
            total *= cells;
        }
        cell *= 1.0625;
    } while (total > (double)count + SPARE_CELLS);
    return (uint32_t)total;
}

/* The cell of a sphere, as an index into scene->start. */
static uint32_t home(const fibrad_scene *scene, const fibrad_level *level, const double centre[3]) {
    uint32_t cell = 0;
    for (int axis = 2; axis >= 0; axis--) {
        int32_t c = fibrad_grid_cell(scene, level, axis, centre[axis]);
        if (c < 0) c = 0; /* by rounding, on a periodic axis */
        if (c >= level->cells[axis]) c = level->cells[axis] - 1;
        cell = cell * (uint32_t)level->cells[axis] + (uint32_t)c;
    }
    return level->first_cell + cell;
}

/* Sorts the spheres by level and cell: a counting sort, stable, in O(n). */
static void sort_into_cells(fibrad_scene *scene, const fibrad_spheres *s) {
    uint32_t count[FIBRAD_LEVELS] = {0}, index[FIBRAD_LEVELS] = {0};
    double largest[FIBRAD_LEVELS] = {0};
    for (uint32_t i = 0; i < s->n; i++) {
        uint32_t level = level_of(radius_of(s, i), scene->facts.radius_min);
        count[level]++;
        largest[level] = fibrad_max(largest[level], radius_of(s, i));
    }
    uint32_t cells = 0, spheres = 0;
    for (uint32_t l = 0; l < FIBRAD_LEVELS; l++) {
        if (count[l] == 0) continue;
        fibrad_level *level = &scene->level[scene->levels];
        level->radius_max = largest[l];
        level->first_cell = cells;
        level->first_sphere = spheres;
        cells += choose_cells(scene, level, count[l]);
        spheres += count[l];
        index[l] = scene->levels++;
    }
    scene->facts.cells = cells;
    fibrad_zero(scene->start, ((size_t)cells + 1) * sizeof *scene->start);

    uint32_t *start = scene->start;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < s->n; i++) {
            double centre[3] = {wrapped(coordinate_of(s, 0, i), scene->low[0], scene->period[0]),
                                wrapped(coordinate_of(s, 1, i), scene->low[1], scene->period[1]),
                                wrapped(coordinate_of(s, 2, i), scene->low[2], scene->period[2])};
            uint32_t cell =
                home(scene, &scene->level[index[level_of(radius_of(s, i), scene->facts.radius_min)]], centre);
            if (pass == 0) {
                start[cell + 1]++;
                continue;
            }
            uint32_t k = start[cell]++;
            scene->x[k] = centre[0], scene->y[k] = centre[1], scene->z[k] = centre[2], scene->r[k] = radius_of(s, i);
            scene->order[k] = i, scene->place[i] = k;
        }
        if (pass == 0) {
            for (uint32_t c = 0; c < cells; c++) start[c + 1] += start[c];
        } else { /* the sort has moved each start to the end of its cell: move the starts back */
            for (uint32_t c = cells; c > 0; c--) start[c] = start[c - 1];
            start[0] = 0;
        }
    }
}

/* Writes the spheres once more as whole numbers. Centres are rounded to half a unit. Radii are rounded up by as much
 * as centres may be off. */
static void write_coarse(fibrad_scene *scene) {
    double per_length[3], off = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double length = side(scene, axis);
        scene->coarse_unit[axis] = length / 65535;
        per_length[axis] = length > 0 ? 65535 / length : 0;
        scene->coarse_low[axis] = scene->box_low[axis] + 0.5 * scene->coarse_unit[axis];
        off += 0.51 * scene->coarse_unit[axis];
    }
    scene->coarse_radius = (scene->facts.radius_max + off) / 65000;
    for (uint32_t i = 0; i < scene->facts.spheres; i++) {
        const double centre[3] = {scene->x[i], scene->y[i], scene->z[i]};
        uint16_t *to = scene->coarse[i / FIBRAD_COARSE].number + i % FIBRAD_COARSE;
        bool stray = false;
        for (int axis = 0; axis < 3; axis++, to += FIBRAD_COARSE) {
            stray = stray || centre[axis] < scene->box_low[axis] || centre[axis] > scene->box_high[axis];
            *to = stray ? 0 : (uint16_t)((centre[axis] - scene->box_low[axis]) * per_length[axis]);
        }
        *to = stray ? FIBRAD_COARSE_STRAY : (uint16_t)((scene->r[i] + off) / scene->coarse_radius + 1);
    }
}

/* A function for two spheres at places i and j, or an image of j, that overlap. A status other than FIBRAD_OK ends the
 * search. */
typedef int overlap_met(fibrad_scene *scene, uint32_t i, uint32_t j, double distance, void *context);

/* Calls a function for each overlap. Spheres of one level are met twice. */
static int each_overlap(fibrad_scene *scene, overlap_met *met, void *context) {
    for (uint32_t l = 0; l < scene->levels; l++) {
        uint32_t end = l + 1 < scene->levels ? scene->level[l + 1].first_sphere : scene->facts.spheres;
        for (uint32_t i = scene->level[l].first_sphere; i < end; i++) {
            for (uint32_t other = 0; other <= l; other++) {
                double reach = scene->r[i] + scene->level[other].radius_max;
                const double centre[3] = {scene->x[i], scene->y[i], scene->z[i]};
                fibrad_walk walk;
                fibrad_walk_about(&walk, scene, &scene->level[other], centre, centre, reach);
                while (fibrad_walk_next(&walk))
                    for (uint32_t j = walk.begin; j < walk.end; j++) {
                        double dx = scene->x[j] - scene->x[i] + walk.shift[0];
                        double dy = scene->y[j] - scene->y[i] + walk.shift[1];
                        double dz = scene->z[j] - scene->z[i] + walk.shift[2], sum = scene->r[i] + scene->r[j];
                        if (fibrad_abs(dx) >= sum || fibrad_abs(dy) >= sum || fibrad_abs(dz) >= sum) continue;
                        if (j == i && !walk.image) continue;
                        /* in units of the sum of the radii, so that no square overflows or vanishes */
                        dx /= sum, dy /= sum, dz /= sum;
                        const int status = met(scene, i, j, sum * fibrad_sqrt(dx * dx + dy * dy + dz * dz), context);
                        if (status != FIBRAD_OK) return status;
                    }
            }
        }
    }
    return FIBRAD_OK;
}

/* Finds the largest overlap, and refuses a centre inside another sphere. Members of a clump may lie within one another.
 * Those in one place are moved apart, since of two spheres the one before the other is seen. */
static int check_overlap(fibrad_scene *scene, uint32_t i, uint32_t j, double distance, void *fault) {
    const uint32_t a = scene->order[i], b = scene->order[j];
    const double sum = scene->r[i] + scene->r[j], smaller = fibrad_min(scene->r[i], scene->r[j]);
    if (i != j && fibrad_one_clump(scene, i, j)) {
        const uint32_t k = fibrad_scene_rank(scene, i) > fibrad_scene_rank(scene, j) ? i : j;
        if (distance == 0) scene->x[k] += fibrad_max(1e-12 * scene->r[k], 4e-16 * fibrad_abs(scene->x[k]));
        return FIBRAD_OK;
    }
    if (distance < sum - smaller || distance == 0)
        return scene_fault(FIBRAD_E_GEOMETRY, fault, a < b ? a : b, a < b ? b : a);
    const double overlap = (sum - distance) / smaller;
    if (overlap > scene->facts.overlap_max) {
        scene->facts.overlap_max = overlap;
        scene->facts.overlap_pair[0] = a, scene->facts.overlap_pair[1] = b;
    }
    return FIBRAD_OK;
}

#define MESH_IMAGES 4096 /* largest number of images of all meshes at one place */

/* The cube root of the volume per sphere. */
static double spacing_of(const fibrad_scene *scene) {
    double longest = 2 * scene->facts.radius_max, volume = 1;
    for (int axis = 0; axis < 3; axis++) longest = fibrad_max(longest, side(scene, axis));
    for (int axis = 0; axis < 3; axis++) volume *= fibrad_max(side(scene, axis), 2 * scene->facts.radius_max) / longest;
    return longest * cube_root(volume / scene->facts.spheres);
}

/* Checks that a mesh is not too small in comparison with its place, the spheres and the walls, and that not too many
 * of its images meet at one place. Error: FIBRAD_E_ARGUMENT. *triangle: out: a triangle at fault. */
static int check_mesh(const fibrad_scene *scene, uint32_t *triangle) {
    const fibrad_mesh *mesh = &scene->mesh;
    double farthest = fibrad_walls_reach(&scene->container), images = 1, most = 0;
    int widest = 3;
    for (int axis = 0; axis < 3; axis++) {
        const double far = fibrad_max(fibrad_abs(scene->low[axis]), fibrad_abs(scene->high[axis]));
        const double own = fibrad_max(fibrad_abs(mesh->low[axis]), fibrad_abs(mesh->high[axis]));
        farthest = fibrad_max(farthest, fibrad_max(far, own));
        if (!(mesh->period[axis] > 0)) continue;
        const double size = mesh->high[axis] - mesh->low[axis], window = 2 * scene->facts.radius_max;
        images *= 2 + (size + window + 2 * mesh->grain) / mesh->period[axis];
        if (size > window && size > most * mesh->period[axis]) most = size / mesh->period[axis], widest = axis;
    }
    const bool small = !(FIBRAD_COORDINATE_MAX * mesh->extent >= fibrad_max(farthest, FIBRAD_LENGTH_MIN));
    if (!small && images <= MESH_IMAGES) return FIBRAD_OK;
    *triangle = small ? 0 : widest < 3 ? fibrad_mesh_highest(mesh, widest) : UINT32_MAX;
    return FIBRAD_E_ARGUMENT;
}

/* Builds the mesh, and finds the distance of each sphere from it. From one sphere to the next this distance changes
 * by at most the distance of the two. */
static int build_mesh(fibrad_scene *scene, const fibrad_scene_config *config, fibrad_fault *fault) {
    uint8_t mesh_of[FIBRAD_WALLS_MAX] = {0};
    const uint32_t n = scene->facts.spheres;
    uint32_t triangle;
    for (uint32_t b = 0; b < config->walls; b++)
        mesh_of[b] = fibrad_slot_is_mesh(scene->slot[b]) ? (uint8_t)fibrad_slot_mesh(scene->slot[b]) : FIBRAD_NO_MESH;
    int status = fibrad_mesh_build(&scene->mesh, config->triangles, scene->period, mesh_of, config->walls,
                                   longest_among(scene), &triangle);
    if (status == FIBRAD_OK) status = check_mesh(scene, &triangle);
    if (status != FIBRAD_OK) {
        if (fault != NULL) *fault = (fibrad_fault){n, n, triangle, 0, 0};
        return status;
    }
    const fibrad_mesh *mesh = &scene->mesh;
    for (uint32_t b = 0; b < config->walls; b++) {
        if (mesh_of[b] == FIBRAD_NO_MESH) continue;
        const double area = scene->wall_area[scene->slot[b]] = fibrad_mesh_area(mesh, mesh_of[b]);
        if (!(area > 0 && fibrad_finite(area))) return scene_fault(FIBRAD_E_ARGUMENT, fault, n, n);
    }
    double before[3], distance = 0;
    fibrad_copy(
        before, mesh->high,
        sizeof before); /* the first point is a corner of the box, so no triangle is farther than the diagonal */
    for (int axis = 0; axis < 3; axis++) distance += mesh->high[axis] - mesh->low[axis];
    for (uint32_t i = 0; i < n; i++) {
        const double at[3] = {scene->x[i], scene->y[i], scene->z[i]};
        for (int axis = 0; axis < 3; axis++) {
            const double step = fibrad_abs(at[axis] - before[axis]), period = mesh->period[axis];
            distance += period > 0 ? fibrad_min(step, period) : step;
        }
        distance = fibrad_mesh_distance(mesh, at, distance * (1 + 1e-6) + mesh->grain);
        fibrad_copy(before, at, sizeof before);
        scene->clear[i] = (float)fibrad_min((distance - mesh->grain) / scene->r[i] * (1 - 1e-6), 1e30);
    }
    return FIBRAD_OK;
}

/* Copies the spheres into a scene with its grid and container. The scene is not complete yet. */
static int lay_out_scene(fibrad_scene **out, void *memory, size_t size, const fibrad_scene_config *config,
                         const fibrad_spheres *given, fibrad_fault *fault) {
    const uint32_t n = given->n, triangles = config->triangles != NULL ? config->triangles->n : 0;
    if (n > 0 && (given->x == NULL || given->y == NULL || given->z == NULL || given->r == NULL))
        return scene_fault(FIBRAD_E_ARGUMENT, fault, n, n);
    fibrad_arena arena;
    int status = triangles > FIBRAD_TRIANGLES_MAX ? FIBRAD_E_ARGUMENT : check_config(config);
    if (status == FIBRAD_OK) {
        size_t needed = fibrad_scene_size(n, given->id != NULL);
        if (needed > 0 && triangles > 0) needed += fibrad_triangles_size(triangles, n);
        if (given->clump != NULL) needed += fibrad_clumps_size(n);
        status = fibrad_arena_open(&arena, memory, size, needed);
    }
    if (status != FIBRAD_OK) return wall_fault(status, fault, n, config), status;

    const fibrad_spheres s = with_strides(given);
    /* the hash is 0 until the scene is complete, so objects of the last scene in this block return FIBRAD_E_STATE */
    fibrad_scene *scene = *out = scene_layout(&arena, n, s.id != NULL, triangles, s.clump != NULL);
    scene->facts.spheres = n;
    scene->facts.walls = config->walls;
    scene->facts.isa = fibrad_isa_choose(config->isa);
    scene->facts.triangles = triangles;
    fibrad_copy(scene->period, config->period, sizeof scene->period);
    fibrad_walls_build(scene, config);
    status = measure_spheres(scene, &s, fault);
    if (status != FIBRAD_OK) return status;
    for (int axis = 0; axis < 3; axis++)
        if (scene->period[axis] > 0 && scene->period[axis] < scene->facts.radius_max)
            return scene_fault(FIBRAD_E_GEOMETRY, fault, n, n);
    if (n > 0) sort_into_cells(scene, &s);
    for (uint32_t k = 0; k < n; k++) {
        const double centre[3] = {scene->x[k], scene->y[k], scene->z[k]};
        scene->cut[k] = scene->container.cuts && fibrad_walls_cut(&scene->container, centre, scene->r[k]);
    }
    if (s.id != NULL && n > 0) fibrad_copy(scene->id, s.id, n * sizeof *s.id);
    for (uint32_t k = 0; k < n && s.clump != NULL; k++) scene->clump[k] = s.clump[scene->order[k]];
    return FIBRAD_OK;
}

int fibrad_scene_init(fibrad_scene **out, void *memory, size_t size, const fibrad_scene_config *given,
                      const fibrad_spheres *spheres, fibrad_fault *fault) {
    const fibrad_scene_config config = given != NULL ? *given : (fibrad_scene_config){0};
    if (out == NULL || spheres == NULL) return scene_fault(FIBRAD_E_ARGUMENT, fault, 0, 0);
    fibrad_scene *scene;
    int status = lay_out_scene(&scene, memory, size, &config, spheres, fault);
    if (status != FIBRAD_OK) return status;
    if (spheres->n > 0) {
        scene->spacing = spacing_of(scene);
        write_coarse(scene);
        status = each_overlap(scene, check_overlap, fault);
        if (status != FIBRAD_OK) return status;
    }
    if (scene->clump != NULL) {
        uint32_t sphere = 0;
        status = fibrad_clumps_build(scene, &sphere);
        if (status != FIBRAD_OK) {
            (void)sphere_fault(fault, sphere, FIBRAD_WHY_CLUMP);
            return status;
        }
    }
    if (scene->facts.triangles > 0) {
        status = build_mesh(scene, &config, fault);
        if (status != FIBRAD_OK) return status;
    }
    fibrad_surroundings_build(scene, &config);
    const fibrad_spheres s = with_strides(spheres);
    scene->hash = hash_of(scene, &s);
    *out = scene;
    return FIBRAD_OK;
}

/* The search for centres inside other spheres. */
typedef struct inside_search {
    double *part;
    uint32_t *other;
    uint64_t left; /* centres that may still be found */
    fibrad_fault *fault;
} inside_search;

#define INSIDE_MOST  64   /* centres inside others that are found, for each sphere */
#define INSIDE_SLACK 1e-9 /* catches a centre at the surface of another sphere whatever the rounding */

static int note_inside(fibrad_scene *scene, uint32_t i, uint32_t j, double distance, void *context) {
    const inside_search *search = context;
    const double larger = fibrad_max(scene->r[i], scene->r[j]), part = distance / larger;
    const uint32_t pair[] = {scene->order[i], scene->order[j]};
    if (!(part < 1 + INSIDE_SLACK) || fibrad_scene_id(scene, pair[0]) == fibrad_scene_id(scene, pair[1]) ||
        fibrad_one_clump(scene, i, j))
        return FIBRAD_OK;
    for (int k = 0; k < 2; k++)
        if (part * (1 - INSIDE_SLACK) < search->part[pair[k]])
            search->part[pair[k]] = part * (1 - INSIDE_SLACK), search->other[pair[k]] = pair[1 - k];
    if (--((inside_search *)context)->left > 0) return FIBRAD_OK;
    const uint32_t largest = pair[scene->r[j] > scene->r[i]];
    return scene_fault(FIBRAD_E_GEOMETRY, search->fault, largest, largest);
}

int fibrad_spheres_inside(const fibrad_spheres *spheres, void *memory, size_t size, double *part, uint32_t *other,
                          fibrad_fault *fault) {
    if (spheres == NULL || (spheres->n > 0 && (part == NULL || other == NULL)))
        return scene_fault(FIBRAD_E_ARGUMENT, fault, 0, 0);
    fibrad_scene *scene;
    const int status = lay_out_scene(&scene, memory, size, &(fibrad_scene_config){0}, spheres, fault);
    if (status != FIBRAD_OK) return status;
    for (uint32_t i = 0; i < spheres->n; i++) part[i] = 1, other[i] = spheres->n;
    inside_search search = {part, other, INSIDE_MOST * (uint64_t)spheres->n, fault};
    return each_overlap(scene, note_inside, &search);
}

double fibrad_scene_wall_area(const fibrad_scene *scene, uint32_t wall) {
    const uint32_t slot = fibrad_scene_ready(scene) ? fibrad_wall_slot(scene, wall) : FIBRAD_NONE;
    return slot != FIBRAD_NONE ? scene->wall_area[slot] : __builtin_nan("");
}

void fibrad_scene_describe(const fibrad_scene *scene, fibrad_scene_facts *facts) {
    if (fibrad_scene_ready(scene) && facts != NULL) *facts = scene->facts;
}

uint32_t fibrad_scene_sphere(const fibrad_scene *scene, uint32_t k) {
    return fibrad_scene_ready(scene) && k < scene->facts.spheres ? scene->order[k] : UINT32_MAX;
}
