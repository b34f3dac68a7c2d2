/* heat.c - lays out a heat problem, moves it to another scene, and has its beams followed. SPDX-License-Identifier: MIT
 */
#include "patches/clump_caps.h"
#include "patches/subdivision.h"
#include "patches/patch_beams_lanes.h"
#include "patches/pencils.h"
#include "heat/sweep.h"
#include "sample/direction.h"

#define HEAT_THIN_MAX  2u
#define HEAT_KEPT      36u /* beams are thinned out only if each patch of a sphere keeps this many */
#define HEAT_NODES_MAX (1u << 26)
#define SPARE_NODES    1024u /* room for fine patches that the bed needs after it has moved */

static fibrad_heat_config heat_config_of(const fibrad_heat_config *config) {
    fibrad_heat_config c = {0};
    if (config != NULL) c = *config;
    if (c.directions == 0) c.directions = FIBRAD_HEAT_DIRECTIONS_DEFAULT;
    if (c.points == 0) c.points = FIBRAD_HEAT_POINTS_DEFAULT;
    if (c.patches == 0) c.patches = FIBRAD_HEAT_PATCHES_DEFAULT;
    if (c.parts == 0) c.parts = FIBRAD_HEAT_PARTS_DEFAULT;
    return c;
}

/* Patches along an edge of a sphere's cube. 0: there is no such number of patches. */
static uint32_t side_of(uint32_t patches) { return patches == 24 ? 2 : patches == 96 ? 4 : patches == 384 ? 8 : 0; }

/* Checks a completed configuration against a scene. Errors: FIBRAD_E_ARGUMENT, _STATE. */
static int heat_check(const fibrad_heat_config *c, const fibrad_scene *scene) {
    fibrad_disc_points set;
    if (scene == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    const bool valid = c->directions >= FIBRAD_DIRECTIONS_MIN && c->directions <= FIBRAD_DIRECTIONS_MAX &&
                       fibrad_disc_points_get(c->points, &set) == FIBRAD_OK && side_of(c->patches) > 0 &&
                       c->parts <= FIBRAD_HEAT_PARTS_MAX && scene->facts.spheres <= (UINT32_MAX >> 1) / c->patches &&
                       c->wall_rays <= FIBRAD_WALL_RAYS_MAX &&
                       (scene->facts.spheres == 0 || (scene->facts.radius_min >= FIBRAD_HEAT_RADIUS_MIN &&
                                                      scene->facts.radius_max <= 1 / FIBRAD_HEAT_RADIUS_MIN));
    return valid ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
}

static uint32_t meshes_of(const fibrad_scene *scene) {
    uint32_t meshes = 0;
    for (uint32_t b = 0; b < scene->facts.walls; b++) meshes += scene->slot[b] >= FIBRAD_MESHES;
    return meshes;
}

/* Sets the numbers that follow from a valid configuration and a scene. Fine patches are not counted. heat->of_mesh is
 * taken as it is. */
static void dimension(fibrad_heat *heat, const fibrad_heat_config *config, const fibrad_scene *scene) {
    const uint32_t spheres = scene->facts.spheres;
    heat->config = *config;
    heat->scene = scene;
    heat->hash = scene->hash;
    heat->spheres = spheres;
    heat->given_walls = scene->facts.walls;
    fibrad_copy(heat->slot, scene->slot, sizeof heat->slot);
    heat->openings = scene->container.openings;
    heat->beams = config->directions * config->points;
    heat->thin = heat->beams / HEAT_THIN_MAX < HEAT_KEPT * config->patches ? 1 : HEAT_THIN_MAX;
    heat->side = side_of(config->patches);
    for (uint32_t level = 0; level < 2; level++) fibrad_harmonics_size(&heat->harmonics[level], heat->side, level == 1);
    heat->meshes = meshes_of(scene), heat->triangles = scene->mesh.triangles;
    heat->bodies = spheres + 2 * FIBRAD_WALLS + heat->meshes + 1;
    heat->patches = spheres * config->patches + 1;
    heat->rays = 0, heat->division.fours = 0;
    fibrad_heat_cut_walls(heat);
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        heat->patches += heat->wall[k].squares[0] * heat->wall[k].squares[1] + heat->wall[k].unbounded;
    for (uint32_t m = 0; m < heat->meshes; m++) heat->patches += heat->of_mesh[m];
}

/* Makes room for a fourth more patches of walls, rays of walls and fine patches than this scene has. A bed that has
 * moved may need them. */
static void add_room(fibrad_heat *heat, uint32_t nodes) {
    const uint32_t of_walls = heat->patches - heat->spheres * heat->config.patches;
    heat->division.nodes_capacity = nodes + (nodes > 1 ? nodes / 4 + SPARE_NODES : 0);
    heat->patches_capacity = heat->patches + of_walls / 4 + FIBRAD_HEAT_FOUR * heat->division.nodes_capacity;
    heat->rays_capacity = heat->rays + heat->rays / 4;
}

static uint32_t tasks_for(uint32_t rows, uint32_t rays) {
    return rows + (rays + FIBRAD_HEAT_TASK - 1) / FIBRAD_HEAT_TASK;
}

/* Takes the arrays of contacts, whose nodes are bodies. The contacts themselves are the caller's. */
static void take_contacts(fibrad_arena *arena, fibrad_heat *heat) {
    fibrad_contacts *c = &heat->contacts;
    fibrad_arena_doubles(arena, heat->bodies,
                         (double **const[]){&c->temperature, &c->stiff, &c->supply, &c->load, &c->warming,
                                            &c->direction, &c->gain, &c->error, &c->diagonal, &c->search, &c->product,
                                            &c->missing, &c->film, &c->gas, &c->shadow, &c->sent, NULL});
    c->slice = fibrad_arena_take(arena, heat->bodies, sizeof *c->slice);
    c->node = fibrad_arena_take(arena, heat->spheres + FIBRAD_WALLS_MAX, sizeof *c->node);
    c->kind = fibrad_arena_take(arena, heat->bodies, 1);
    c->nodes = heat->bodies;
    heat->checked_node = fibrad_arena_take(arena, heat->spheres + FIBRAD_WALLS_MAX, sizeof *heat->checked_node);
    heat->checked_kind = fibrad_arena_take(arena, heat->bodies, 1);
    heat->joined.root = fibrad_arena_take(arena, heat->bodies + 1, sizeof *heat->joined.root);
    heat->joined.anchored = fibrad_arena_take(arena, heat->bodies + 1, 1);
    heat->checked = fibrad_arena_take(arena, 1, sizeof *heat->checked);
}

/* Takes the arrays of clumps, if the scene has any. */
static void take_clumps(fibrad_arena *arena, fibrad_heat *heat) {
    heat->end = heat->contacts.node, heat->film = heat->contacts.film, heat->gas = heat->contacts.gas;
    if (heat->scene->clump == NULL) return;
    heat->end = fibrad_arena_take(arena, heat->spheres + FIBRAD_WALLS_MAX, sizeof *heat->end);
    fibrad_arena_doubles(arena, heat->bodies, (double **const[]){&heat->film, &heat->gas, NULL});
    heat->clumps.leader = fibrad_arena_take(arena, heat->spheres, sizeof *heat->clumps.leader);
    heat->clumps.first_cap = fibrad_arena_take(arena, heat->spheres + (size_t)1, sizeof *heat->clumps.first_cap);
    heat->clumps.cap = fibrad_arena_take(arena, heat->clumps.room, sizeof *heat->clumps.cap);
}

/* Takes the arrays from the arena. The caller copies the object itself to the address that is returned. */
static fibrad_heat *heat_layout(fibrad_arena *arena, fibrad_heat *heat) {
    fibrad_heat *place = fibrad_arena_take(arena, 1, sizeof *place);
    const uint32_t spheres = heat->spheres, patches = heat->patches_capacity, nodes = heat->division.nodes_capacity;
    const uint32_t rows = spheres + nodes, others = patches - spheres * heat->config.patches;
    heat->first = fibrad_arena_take(arena, heat->bodies + 1, sizeof *heat->first);
    heat->leave = fibrad_arena_take(arena, heat->beams, sizeof *heat->leave);
    heat->ray = fibrad_arena_take(arena, heat->rays_capacity, sizeof *heat->ray);
    heat->met = fibrad_arena_take(arena, heat->meshes > 0 ? heat->rays_capacity : 0, sizeof *heat->met);
    heat->first_met = fibrad_arena_take(arena, heat->config.parts + 2, sizeof *heat->first_met);
    heat->solution.brought =
        fibrad_arena_take(arena, (size_t)others * heat->config.parts, sizeof *heat->solution.brought);
    heat->solution.back = fibrad_arena_take(arena, others, sizeof *heat->solution.back);
    fibrad_arena_doubles(arena, patches,
                         (double **const[]){&heat->solution.source, &heat->solution.gathered, &heat->solution.area,
                                            &heat->solution.net, &heat->solution.radiosity, &heat->solution.detail,
                                            &heat->solution.direction, NULL});
    fibrad_arena_doubles(arena, heat->bodies,
                         (double **const[]){&heat->sources.emissivity, &heat->sources.emission,
                                            &heat->sources.given_power, &heat->sources.storage, &heat->solution.coarse,
                                            &heat->solution.coarse_emission, &heat->sources.temperature,
                                            &heat->solution.power, &heat->samples.halves, &heat->solution.drift,
                                            &heat->solution.left, &heat->solution.unsettled, NULL});
    for (uint32_t level = 0; level < 2; level++) {
        fibrad_harmonics *h = &heat->harmonics[level];
        h->patch = fibrad_arena_take(arena, FIBRAD_HARMONICS_KINDS * h->orbits, sizeof *h->patch);
        h->root = fibrad_arena_take(arena, h->orbits, sizeof *h->root);
        h->value = fibrad_arena_take(arena, FIBRAD_HARMONICS_KINDS * h->orbits * h->many, sizeof *h->value);
    }
    take_contacts(arena, heat);
    take_clumps(arena, heat);
    fibrad_arena_doubles(arena, spheres,
                         (double **const[]){&heat->sources.conductivity, &heat->sources.unevenness, NULL});
    heat->solution.span = fibrad_arena_take(arena, spheres, sizeof *heat->solution.span);
    heat->normal = fibrad_arena_take(arena, 12 * (size_t)heat->config.patches, sizeof(double));
    heat->rings = fibrad_arena_take(arena, 1, sizeof *heat->rings);
    heat->near = fibrad_arena_take(arena, heat->config.parts, sizeof *heat->near);
    heat->density = fibrad_arena_take(arena, rows, sizeof(double));
    heat->samples.seen = fibrad_arena_take(arena, spheres, sizeof *heat->samples.seen);
    heat->pencils.row = fibrad_arena_take(arena, rows, sizeof *heat->pencils.row);
    heat->pencils.first_link = fibrad_arena_take(arena, rows + 2, sizeof *heat->pencils.first_link);
    heat->order = fibrad_arena_take(arena, spheres, sizeof *heat->order);
    heat->sequence = fibrad_arena_take(arena, spheres, sizeof *heat->sequence);
    heat->part = fibrad_arena_take(arena, rows, sizeof *heat->part);
    heat->division.root = fibrad_arena_take(arena, spheres + FIBRAD_WALLS, sizeof *heat->division.root);
    heat->division.node = fibrad_arena_take(arena, nodes, sizeof *heat->division.node);
    heat->division.first_four = fibrad_arena_take(arena, spheres + FIBRAD_WALLS + 1, sizeof *heat->division.first_four);
    heat->division.four = fibrad_arena_take(arena, nodes, sizeof *heat->division.four);
    heat->division.on_patch = fibrad_arena_take(arena, nodes, sizeof *heat->division.on_patch);
    heat->division.fine = fibrad_arena_take(arena, nodes, sizeof *heat->division.fine);
    heat->cut = fibrad_arena_take(arena, 2 * (size_t)heat->triangles, sizeof *heat->cut);
    heat->sources.excess = fibrad_arena_take(arena, heat->triangles > 0 ? others : 0, sizeof *heat->sources.excess);
    heat->sources.still = fibrad_arena_take(arena, heat->triangles > 0 ? others : 0, sizeof *heat->sources.still);
    heat->sources.answer = fibrad_arena_take(arena, heat->triangles > 0 ? others : 0, sizeof *heat->sources.answer);
    heat->sources.within = fibrad_arena_take(arena, heat->triangles > 0 ? others : 0, 1);
    heat->traced = fibrad_arena_take(arena, tasks_for(rows, heat->rays_capacity), 1);
    heat->swept = fibrad_arena_take(arena, heat->config.parts, 1);
    heat->pencils.pool = fibrad_arena_take(arena, heat->pencils.room, 1);
    return place;
}

/* Sets the numbers of a new problem, with room for a bed that moves and for the beams. Error: FIBRAD_E_UNSUPPORTED. */
static int dimension_anew(fibrad_heat *heat, const fibrad_heat_config *config, const fibrad_scene *scene) {
    dimension(heat, config, scene);
    fibrad_heat_cut_meshes(heat);
    dimension(heat, config, scene);
    const uint64_t nodes = fibrad_heat_count_nodes(heat);
    if (nodes > HEAT_NODES_MAX) return FIBRAD_E_UNSUPPORTED;
    add_room(heat, (uint32_t)nodes);
    const size_t caps = fibrad_heat_count_caps(scene);
    heat->clumps.room = caps + caps / 4;
    heat->pencils.room = fibrad_heat_room(heat);
    return FIBRAD_OK;
}

static size_t heat_bytes(fibrad_heat fields) {
    fibrad_arena arena = {0};
    heat_layout(&arena, &fields);
    return fibrad_arena_total(&arena);
}

size_t fibrad_heat_size(const fibrad_heat_config *config, const fibrad_scene *scene) {
    const fibrad_heat_config c = heat_config_of(config);
    if (heat_check(&c, scene) != FIBRAD_OK) return 0;
    fibrad_heat fields = {0};
    return dimension_anew(&fields, &c, scene) == FIBRAD_OK ? heat_bytes(fields) : 0;
}

static uint32_t patches_of(const fibrad_heat *heat, uint32_t b) {
    const uint32_t mesh = fibrad_heat_body(heat, FIBRAD_MESHES), beyond = fibrad_heat_beyond(heat, 0);
    const uint32_t fine =
        b < mesh ? FIBRAD_HEAT_FOUR * (heat->division.first_four[b + 1] - heat->division.first_four[b]) : 0;
    if (b < heat->spheres) return heat->config.patches + fine;
    if (b < mesh) return heat->wall[b - heat->spheres].squares[0] * heat->wall[b - heat->spheres].squares[1] + fine;
    if (b < beyond) return heat->of_mesh[b - mesh];
    return b < beyond + FIBRAD_WALLS ? heat->wall[b - beyond].unbounded : 1;
}

/* The normal where the beam of a point leaves. */
static void normal_of_beam(const fibrad_disc_points *set, const double frame[9], uint32_t p, double n[3]) {
    const double x = set->x[p], y = set->y[p], up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
    for (int axis = 0; axis < 3; axis++) n[axis] = x * frame[axis] + y * frame[3 + axis] + up * frame[6 + axis];
}

/* Divides the beams that leave the exposed part of a member of a clump by its area. */
static void correct_densities(fibrad_heat *heat) {
    const uint32_t points = heat->config.points;
    fibrad_disc_points set = {NULL, NULL};
    if (fibrad_disc_points_get(points, &set) != FIBRAD_OK) return;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        uint32_t open = 0;
        if (!fibrad_heat_is_member(heat, b)) continue;
        for (uint32_t k = 0; k < heat->config.directions; k++) {
            double frame[9], n[3];
            fibrad_beam_frame(k, heat->config.directions, points, frame);
            for (uint32_t p = 0; p < points; p++) {
                normal_of_beam(&set, frame, p, n);
                open += !fibrad_heat_is_hidden(heat, b, n);
            }
        }
        if (open > 0) heat->density[b] = open / heat->scene->clumps.exposed[b];
    }
}

/* Sets the first patch of each body, and how many beams leave each sphere per area. */
static void number_patches(fibrad_heat *heat) {
    const fibrad_scene *scene = heat->scene;
    heat->first[0] = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) heat->first[b + 1] = heat->first[b] + patches_of(heat, b);
    for (uint32_t b = 0; b < heat->spheres; b++)
        heat->density[b] = heat->beams / (4 * FIBRAD_PI * scene->r[b] * scene->r[b]);
    if (heat->clumps.some) correct_densities(heat);
}

/* Finds the patch of its sphere that each beam leaves. */
static void find_origins(fibrad_heat *heat) {
    const uint32_t points = heat->config.points;
    fibrad_disc_points set = {NULL, NULL};
    if (fibrad_disc_points_get(points, &set) != FIBRAD_OK) return;
    for (uint32_t k = 0; k < heat->config.directions; k++) {
        double frame[9], n[3];
        fibrad_beam_frame(k, heat->config.directions, points, frame);
        for (uint32_t p = 0; p < points; p++) {
            normal_of_beam(&set, frame, p, n);
            heat->leave[k * points + p] = (uint16_t)fibrad_patch_of(n, heat->side);
        }
    }
}

/* Prepares a problem for its scene. No beam has been followed. */
static void forget_beams(fibrad_heat *heat) {
    fibrad_heat_find_clumps(heat);
    fibrad_heat_divide_fours(heat);
    heat->patches += FIBRAD_HEAT_FOUR * heat->division.fours;
    number_patches(heat);
    fibrad_heat_divide(heat);
    fibrad_copy(heat->order, heat->scene->order, heat->spheres * sizeof *heat->order);
    fibrad_zero(heat->traced, fibrad_heat_tasks(heat));
    heat->pencils.used = heat->pencils.links = 0;
    heat->solution.areas = false;
    heat->solution.phase = FIBRAD_HEAT_IDLE;
}

int fibrad_heat_init(fibrad_heat **out, void *memory, size_t size, const fibrad_heat_config *config,
                     const fibrad_scene *scene) {
    if (out == NULL) return FIBRAD_E_ARGUMENT;
    const fibrad_heat_config c = heat_config_of(config);
    fibrad_arena arena;
    fibrad_heat fields = {0};
    int status = heat_check(&c, scene);
    if (status != FIBRAD_OK) return status;
    status = dimension_anew(&fields, &c, scene);
    if (status != FIBRAD_OK) return status;
    const size_t least = heat_bytes(fields);
    status = fibrad_arena_open(&arena, memory, size, least);
    if (status != FIBRAD_OK) return status;
    fields.pencils.room += (size - least) / FIBRAD_ALIGNMENT * FIBRAD_ALIGNMENT;
    fibrad_heat *heat = heat_layout(&arena, &fields);
    *heat = fields;
    *heat->checked = heat->contacts;
    heat->checked->node = heat->checked_node, heat->checked->kind = heat->checked_kind;
    fibrad_heat_cut_meshes(heat);
    find_origins(heat);
    for (int level = 0; level < 2; level++) fibrad_harmonics_make(&heat->harmonics[level]);
    fibrad_zero(heat->sources.unevenness, heat->spheres * sizeof(double));
    fibrad_zero(heat->solution.coarse, heat->bodies * sizeof(double));
    fibrad_zero(heat->solution.coarse_emission, heat->bodies * sizeof(double));
    fibrad_heat_balance(heat);
    fibrad_sobol_make(&heat->sobol);
    forget_beams(heat);
    *out = heat;
    return FIBRAD_OK;
}

/* Puts values, `each` per sphere, into the order of another scene. scratch: [each n] */
static void reorder(double *value, uint32_t each, const fibrad_scene *scene, const uint32_t *old_place, uint32_t n,
                    double *scratch) {
    for (uint32_t place = 0; place < n; place++)
        fibrad_copy(scratch + (size_t)place * each, value + (size_t)old_place[scene->order[place]] * each,
                    each * sizeof *value);
    fibrad_copy(value, scratch, (size_t)n * each * sizeof *value);
}

/* Whether all planes and the cylinder have as many patches in one problem as in the other. */
static bool same_patches(const fibrad_heat *a, const fibrad_heat *b) {
    bool same = true;
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        const fibrad_heat_wall *x = &a->wall[k], *y = &b->wall[k];
        same = same && x->squares[0] == y->squares[0] && x->squares[1] == y->squares[1] && x->unbounded == y->unbounded;
    }
    return same;
}

/* Puts the radiosities of the last solution in the order of the next scene. If planes or the cylinder have another
 * number of patches there, their patches begin with the emission of their wall. */
static void carry_over(fibrad_heat *heat, const fibrad_heat *next) {
    const uint32_t n = heat->spheres, each = heat->config.patches;
    uint32_t *old_place = (uint32_t *)(void *)heat->solution.source;
    for (uint32_t place = 0; place < n; place++) old_place[heat->order[place]] = place;
    reorder(heat->solution.radiosity, each, next->scene, old_place, n, heat->solution.gathered);
    reorder(heat->solution.detail, each, next->scene, old_place, n, heat->solution.gathered);
    reorder(heat->sources.emission, 1, next->scene, old_place, n, heat->solution.gathered);
    if (same_patches(heat, next)) return;
    const uint32_t mesh = fibrad_heat_body(heat, FIBRAD_MESHES), from = heat->first[mesh];
    const size_t of_meshes = (heat->first[fibrad_heat_beyond(heat, 0)] - from) * sizeof *heat->solution.radiosity;
    fibrad_copy(heat->solution.gathered, heat->solution.radiosity + from, of_meshes);
    fibrad_copy(heat->solution.direction, heat->solution.detail + from, of_meshes);
    uint32_t a = n * each, to = a;
    for (uint32_t b = n; b < heat->bodies; b++) {
        if (b == mesh) to = a;
        for (uint32_t end = a + patches_of(next, b); a < end; a++)
            heat->solution.radiosity[a] = heat->sources.emission[b], heat->solution.detail[a] = 0;
    }
    fibrad_copy(heat->solution.radiosity + to, heat->solution.gathered, of_meshes);
    fibrad_copy(heat->solution.detail + to, heat->solution.direction, of_meshes);
}

/* Removes fine patches. Own patches that were divided take the mean of their body. */
static void drop_fine(fibrad_heat *heat) {
    if (heat->division.fours == 0) return;
    uint32_t to = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double mean = fibrad_heat_mean(heat, b, heat->solution.radiosity);
        const bool has_fine = b < fibrad_heat_body(heat, FIBRAD_MESHES) && heat->division.root[b] != FIBRAD_NONE;
        const uint32_t end = has_fine ? fibrad_heat_first_fine(heat, b) : heat->first[b + 1];
        for (uint32_t a = heat->first[b]; a < end; a++, to++) {
            const bool divided = has_fine && !(heat->solution.area[a] > 0);
            heat->solution.radiosity[to] = divided ? mean : heat->solution.radiosity[a];
            heat->solution.detail[to] = divided ? 0 : heat->solution.detail[a];
        }
    }
    heat->division.fours = 0;
    fibrad_zero(heat->division.first_four, (heat->spheres + FIBRAD_WALLS + 1) * sizeof *heat->division.first_four);
    for (uint32_t b = 0; b < heat->bodies; b++) heat->first[b + 1] = heat->first[b] + patches_of(heat, b);
}

/* Makes room for fine patches among the radiosities. They begin with the mean of their body. */
static void add_fine(fibrad_heat *heat) {
    uint32_t from = heat->patches - FIBRAD_HEAT_FOUR * heat->division.fours;
    for (uint32_t b = heat->bodies; heat->division.fours > 0 && b-- > 0;) {
        const bool has_fine = b < fibrad_heat_body(heat, FIBRAD_MESHES) && heat->division.root[b] != FIBRAD_NONE;
        const uint32_t begin = heat->first[b], end = has_fine ? fibrad_heat_first_fine(heat, b) : heat->first[b + 1];
        double sum = 0;
        for (uint32_t a = end; a-- > begin;) {
            heat->solution.radiosity[a] = heat->solution.radiosity[--from],
            heat->solution.detail[a] = heat->solution.detail[from];
            sum += heat->solution.radiosity[a];
        }
        for (uint32_t a = end; a < heat->first[b + 1]; a++)
            heat->solution.radiosity[a] = sum / (end - begin), heat->solution.detail[a] = 0;
    }
}

/* Whether a scene has as many triangles as the problem, and each side belongs to the same wall as before. */
static bool same_triangles(const fibrad_heat *heat, const fibrad_scene *scene) {
    const fibrad_mesh *mesh = &scene->mesh;
    const uint32_t *first = heat->first + fibrad_heat_body(heat, FIBRAD_MESHES);
    bool same = mesh->triangles == heat->triangles;
    for (uint32_t s = 0; same && s < 2 * mesh->triangles; s++) {
        const uint32_t m = fibrad_side_mesh(mesh, s), patch = heat->cut[fibrad_side_given(mesh, s)].patch;
        same = m == FIBRAD_NO_MESH || fibrad_mesh_area(mesh, m) == 0
                   ? patch == UINT32_MAX
                   : patch >= first[m] - first[0] && patch < first[m + 1] - first[0];
    }
    return same;
}

int fibrad_heat_move(fibrad_heat *heat, const fibrad_scene *scene) {
    if (heat == NULL || scene == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    if (scene->facts.spheres != heat->spheres || scene->facts.walls != heat->given_walls) return FIBRAD_E_ARGUMENT;
    for (uint32_t b = 0; b < heat->given_walls; b++)
        if (scene->slot[b] != heat->slot[b]) return FIBRAD_E_ARGUMENT;
    if (scene->container.openings != heat->openings) return FIBRAD_E_ARGUMENT;
    if ((scene->clump != NULL) != (heat->clumps.leader != NULL)) return FIBRAD_E_ARGUMENT;
    if (!same_triangles(heat, scene)) return FIBRAD_E_ARGUMENT;
    fibrad_heat next = *heat;
    dimension(&next, &heat->config, scene);
    const uint64_t nodes = fibrad_heat_count_nodes(&next);
    if (nodes > heat->division.nodes_capacity || next.patches + FIBRAD_HEAT_FOUR * nodes > heat->patches_capacity ||
        next.rays > heat->rays_capacity || fibrad_heat_count_caps(scene) > heat->clumps.room)
        return FIBRAD_E_SIZE;
    if (heat->solution.warm) drop_fine(heat), carry_over(heat, &next);
    *heat = next;
    forget_beams(heat);
    if (heat->solution.warm) add_fine(heat);
    return FIBRAD_OK;
}

/* The patches of a body begin with those of the last problem, or with their mean if their number is another. */
static void resume_body(fibrad_heat *heat, const fibrad_heat *last, uint32_t b) {
    const uint32_t from = last->first[b], n = last->first[b + 1] - from, to = heat->first[b];
    const bool same = n == heat->first[b + 1] - to;
    double sum = 0;
    for (uint32_t k = 0; k < n; k++) sum += last->solution.radiosity[from + k];
    for (uint32_t k = 0; k < heat->first[b + 1] - to; k++) {
        heat->solution.radiosity[to + k] = same ? last->solution.radiosity[from + k] : n > 0 ? sum / n : 0;
        heat->solution.detail[to + k] = same ? last->solution.detail[from + k] : 0;
    }
    heat->sources.emission[b] = last->sources.emission[b];
}

int fibrad_heat_resume(fibrad_heat *heat, const fibrad_heat *last) {
    if (heat == NULL || last == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->scene != last->scene || heat->bodies != last->bodies || !last->solution.warm) return FIBRAD_E_STATE;
    for (uint32_t b = 0; b < heat->bodies; b++) resume_body(heat, last, b);
    heat->sources.light = last->sources.light;
    heat->sources.sigma = last->sources.sigma, heat->sources.surroundings = last->sources.surroundings;
    heat->solution.warm = true;
    return FIBRAD_OK;
}

uint32_t fibrad_heat_tasks(const fibrad_heat *heat) { return heat != NULL ? tasks_for(heat->rows, heat->rays) : 0; }

uint32_t fibrad_heat_parts(const fibrad_heat *heat) { return heat != NULL ? heat->config.parts : 0; }

int fibrad_heat_trace(fibrad_heat *heat, fibrad_work *work, uint32_t task) {
    if (heat == NULL || work == NULL || task >= fibrad_heat_tasks(heat)) return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat) || heat->traced[task]) return FIBRAD_E_STATE;
    const size_t scratch = fibrad_heat_scratch(heat);
    fibrad_workspace *space;
    int status = fibrad_work_open(work, heat->scene, scratch, scratch, &space);
    while (status == FIBRAD_OK) {
        status = FIBRAD_VERSION_OF(fibrad_heat_follow, heat->scene->facts.isa)(heat, space, task);
        if (status != FIBRAD_E_WORK) break;
        status = fibrad_work_grow(work, &space);
    }
    if (status == FIBRAD_E_BACK) work->triangle = space->back;
    if (status == FIBRAD_OK) heat->traced[task] = 1;
    return status;
}
