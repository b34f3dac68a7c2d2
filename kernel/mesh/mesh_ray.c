/* mesh_ray.c - the first side that a ray meets, and the distance from a point to the nearest triangle.
 * SPDX-License-Identifier: MIT */
#include "base/vector.h"
#include "mesh/mesh.h"

static int64_t whole_below(double x) { return (int64_t)fibrad_max(-0x1p62, fibrad_min(0x1p62, fibrad_floor(x))); }

fibrad_mesh_images fibrad_mesh_images_in(const fibrad_mesh *mesh, const double low[3], const double high[3]) {
    fibrad_mesh_images images = {{0}, {0}};
    for (int axis = 0; axis < 3; axis++) {
        if (!(mesh->period[axis] > 0)) continue;
        const double inverse = 1 / mesh->period[axis], grain = mesh->grain * inverse;
        images.first[axis] = -whole_below((mesh->high[axis] - low[axis]) * inverse + grain);
        images.last[axis] = whole_below((high[axis] - mesh->low[axis]) * inverse + grain);
    }
    return images;
}

/* A ray in the frame of one image. The coordinates are exchanged so that w is longest along the last one. Then they
 * are sheared so that the ray is the last axis. Source: S. Woop, C. Benthin, I. Wald, J. Comput. Graph. Tech. 2
 * (2013) 65. */
typedef struct sheared_ray {
    int axis[3];
    double origin[3], shear[2], inverse; /* inverse: 1 over w along the last axis */
    float middle[3], over[3],
        pad;      /* for comparisons with boxes, in units of boxes: origin, 1/w, bound of the rounding errors */
    double begin; /* minus one grain */
    uint32_t except;
} sheared_ray;

static sheared_ray shear_ray(const fibrad_mesh *mesh, const double w[3], uint32_t except) {
    sheared_ray ray = {.begin = -mesh->grain, .except = except};
    int last = fibrad_abs(w[1]) > fibrad_abs(w[0]) ? 1 : 0;
    if (fibrad_abs(w[2]) > fibrad_abs(w[last])) last = 2;
    const int turned = w[last] < 0; /* then two coordinates are exchanged, which keeps the sense of rotation */
    ray.axis[0] = (last + 1 + turned) % 3, ray.axis[1] = (last + 2 - turned) % 3, ray.axis[2] = last;
    ray.inverse = 1 / w[last];
    for (int k = 0; k < 2; k++) ray.shear[k] = w[ray.axis[k]] * ray.inverse;
    for (int axis = 0; axis < 3; axis++) /* finite, also times any length of the scene */
        ray.over[axis] = (float)(fibrad_abs(w[axis]) > 1e-30 ? 1 / w[axis] : 1e30);
    return ray;
}

static void place_ray(const fibrad_mesh *mesh, const double origin[3], const double shift[3], sheared_ray *ray) {
    double far = 1;
    for (int axis = 0; axis < 3; axis++) {
        ray->origin[axis] = origin[axis] - shift[axis];
        const double at = (ray->origin[axis] - mesh->middle[axis]) / mesh->extent;
        ray->middle[axis] = (float)at;
        far = fibrad_max(far, fibrad_abs(at));
    }
    ray->pad = (float)(1e-6 * far);
}

/* The first side so far. A back counts as one grain farther away, so that fronts come first at edges. */
typedef struct first_side {
    double distance, key; /* key: the distance; for backs the distance plus one grain */
    uint32_t side, number;
} first_side;

/* Whether a ray begins in the plane of a triangle. This holds for the triangle that the ray leaves, but not for its
 * images to the side. */
static bool begins_in_plane(const fibrad_mesh *mesh, const sheared_ray *ray, uint32_t t) {
    double normal[3], height = 0;
    fibrad_mesh_normal(mesh, fibrad_side(t, false), normal);
    for (int axis = 0; axis < 3; axis++) height += normal[axis] * (mesh->corner[0][axis][t] - ray->origin[axis]);
    return fibrad_abs(height) <= mesh->grain;
}

static void meet_triangle(const fibrad_mesh *mesh, const sheared_ray *ray, uint32_t t, first_side *first) {
    double at[3][2], along[3];
    for (int k = 0; k < 3; k++) {
        double *const *c = mesh->corner[k];
        along[k] = c[ray->axis[2]][t] - ray->origin[ray->axis[2]];
        for (int a = 0; a < 2; a++)
            at[k][a] = c[ray->axis[a]][t] - ray->origin[ray->axis[a]] - ray->shear[a] * along[k];
    }
    const double a = at[1][0] * at[2][1] - at[1][1] * at[2][0], b = at[2][0] * at[0][1] - at[2][1] * at[0][0];
    const double c = at[0][0] * at[1][1] - at[0][1] * at[1][0], sum = a + b + c;
    if (!((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0)) || sum == 0) return;
    const double distance = (a * along[0] + b * along[1] + c * along[2]) / sum * ray->inverse;
    const bool back = sum > 0;
    const double key = back ? distance + mesh->grain : distance;
    if (!(distance > (back ? mesh->grain : ray->begin))) return;
    if (key > first->key || (key == first->key && mesh->number[t] >= first->number)) return;
    if (t == ray->except && begins_in_plane(mesh, ray, t)) return;
    *first = (first_side){fibrad_max(0, distance), key, fibrad_side(t, back), mesh->number[t]};
}

/* Enters a node. Visits the boxes that the ray may meet within the length `to`, which is in units of boxes, the
 * nearest first. */
static void enter_on_ray(const fibrad_mesh *mesh, fibrad_mesh_walk *walk, uint32_t number, const sheared_ray *ray,
                         float to) {
    const fibrad_mesh_node *node = &mesh->node[number];
    float from[FIBRAD_MESH_WIDE], until[FIBRAD_MESH_WIDE];
    uint32_t boxes = 0;
    for (uint32_t k = 0; k < FIBRAD_MESH_WIDE; k++) from[k] = -ray->pad, until[k] = to;
    for (int axis = 0; axis < 3; axis++) {
        const float origin = ray->middle[axis], over = ray->over[axis], size = over < 0 ? -over : over;
        for (uint32_t k = 0; k < FIBRAD_MESH_WIDE; k++) {
            const float middle = (node->middle[axis][k] - origin) * over,
                        half = (node->half[axis][k] + ray->pad) * size;
            from[k] = middle - half > from[k] ? middle - half : from[k];
            until[k] = middle + half < until[k] ? middle + half : until[k];
        }
    }
    for (uint32_t k = 0; k < FIBRAD_MESH_WIDE; k++) boxes |= (uint32_t)(from[k] <= until[k]) << k;
    fibrad_mesh_enter(walk, number, boxes, from);
}

/* A length [L] in units of boxes, rounded up. */
static float length_for_boxes(const fibrad_mesh *mesh, const sheared_ray *ray, double length) {
    return (float)(fibrad_min(length / mesh->extent * 1.000001, 1e20) + (double)ray->pad);
}

static void meet_image(const fibrad_mesh *mesh, const sheared_ray *ray, first_side *first) {
    fibrad_mesh_walk walk = {.level = 0};
    if (mesh->nodes > 0) enter_on_ray(mesh, &walk, 0, ray, length_for_boxes(mesh, ray, first->key));
    for (uint32_t child; fibrad_mesh_next(&walk, mesh, &child);) {
        const uint32_t place = child / 16, count = fibrad_mesh_leaf(child);
        for (uint32_t t = place; t < place + count; t++) meet_triangle(mesh, ray, t, first);
        if (count == 0) enter_on_ray(mesh, &walk, place, ray, length_for_boxes(mesh, ray, first->key));
    }
}

/* The length of one search: the whole length without periodic axes, otherwise about a period, so that there are few
 * images. */
static double stretch_along(const fibrad_mesh *mesh, const double origin[3], const double w[3], double *to) {
    double stretch = *to;
    for (int axis = 0; axis < 3; axis++) {
        if (!(mesh->period[axis] > 0)) { /* until the ray leaves the box about all triangles */
            const double ahead = (w[axis] > 0 ? mesh->high[axis] : mesh->low[axis]) - origin[axis];
            if (w[axis] != 0) *to = fibrad_min(*to, 1.0001 * fibrad_max(0, ahead / w[axis]) + mesh->grain);
            continue;
        }
        stretch = fibrad_min(stretch, mesh->period[axis]);
        if (w[axis] != 0) *to = fibrad_min(*to, FIBRAD_PERIODS * mesh->period[axis] / fibrad_abs(w[axis]));
    }
    return fibrad_max(stretch, *to / FIBRAD_MESH_STRETCHES);
}

fibrad_mesh_hit fibrad_mesh_first(const fibrad_mesh *mesh, const double origin[3], const double w[3], double to,
                                  uint32_t except) {
    sheared_ray ray = shear_ray(mesh, w, except);
    first_side first = {to, to, FIBRAD_NO_SIDE, 0};
    const double stretch = stretch_along(mesh, origin, w, &to);
    double from = 0;
    for (bool more = true; more;) {
        double low[3], high[3];
        const double until = fibrad_min(from + stretch, to);
        for (int axis = 0; axis < 3; axis++) {
            const double a = w[axis] == 0 ? 0 : from * w[axis], b = w[axis] == 0 ? 0 : until * w[axis];
            low[axis] = origin[axis] + fibrad_min(a, b), high[axis] = origin[axis] + fibrad_max(a, b);
        }
        const fibrad_mesh_images images = fibrad_mesh_images_in(mesh, low, high);
        for (int64_t z = images.first[2]; z <= images.last[2]; z++)
            for (int64_t y = images.first[1]; y <= images.last[1]; y++)
                for (int64_t x = images.first[0]; x <= images.last[0]; x++) {
                    const double shift[3] = {(double)x * mesh->period[0], (double)y * mesh->period[1],
                                             (double)z * mesh->period[2]};
                    place_ray(mesh, origin, shift, &ray);
                    meet_image(mesh, &ray, &first);
                }
        more = until > from && until < to && until < first.key;
        from = until;
    }
    return (fibrad_mesh_hit){first.side, first.distance};
}

void fibrad_mesh_normal(const fibrad_mesh *mesh, uint32_t side, double normal[3]) {
    double c[3][3], a[3], b[3], square = 0, longest = 0;
    fibrad_mesh_corners(mesh, fibrad_side_triangle(side), c);
    for (int axis = 0; axis < 3; axis++) a[axis] = c[1][axis] - c[0][axis], b[axis] = c[2][axis] - c[0][axis];
    fibrad_cross(a, b, normal);
    for (int axis = 0; axis < 3; axis++) longest = fibrad_max(longest, fibrad_abs(normal[axis]));
    for (int axis = 0; axis < 3; axis++) normal[axis] /= longest, square += normal[axis] * normal[axis];
    const double scale = (fibrad_side_is_back(side) ? -1 : 1) / fibrad_sqrt(square);
    for (int axis = 0; axis < 3; axis++) normal[axis] *= scale;
}

void fibrad_mesh_triangle_point(const fibrad_mesh *mesh, uint32_t triangle, const double share[2], double point[3]) {
    double corner[3][3];
    fibrad_mesh_corners(mesh, triangle, corner);
    const double root = fibrad_sqrt(share[0]), part[2] = {root * (1 - share[1]), root * share[1]};
    for (int axis = 0; axis < 3; axis++) {
        const double origin = corner[0][axis];
        point[axis] = origin + part[0] * (corner[1][axis] - origin) + part[1] * (corner[2][axis] - origin);
    }
}

uint32_t fibrad_mesh_side_at(const fibrad_mesh *mesh, uint32_t number, double at, double *before) {
    const uint32_t first = mesh->first[number];
    uint32_t low = first, high = mesh->first[number + 1] - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (mesh->area[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    *before = low > first ? mesh->area[low - 1] : 0;
    return low;
}

uint32_t fibrad_mesh_point(const fibrad_mesh *mesh, uint32_t number, const double share[2], double point[3]) {
    double before;
    const double at = share[0] * fibrad_mesh_area(mesh, number);
    const uint32_t low = fibrad_mesh_side_at(mesh, number, at, &before);
    const double own = mesh->area[low] - before;
    const double of_own[2] = {own > 0 ? fibrad_max(0, fibrad_min(1, (at - before) / own)) : 0, share[1]};
    fibrad_mesh_triangle_point(mesh, fibrad_side_triangle(mesh->side[low]), of_own, point);
    return mesh->side[low];
}

static double clamp_share(double above, double below) {
    return below > 0 ? fibrad_max(0, fibrad_min(1, above / below)) : 0;
}

/* Square of the distance from the origin to a segment. */
static double square_to_segment(const double a[3], const double b[3]) {
    double along[3], at[3];
    for (int axis = 0; axis < 3; axis++) along[axis] = b[axis] - a[axis];
    const double share = clamp_share(-fibrad_dot(a, along), fibrad_dot(along, along));
    for (int axis = 0; axis < 3; axis++) at[axis] = a[axis] + share * along[axis];
    return fibrad_dot(at, at);
}

/* Square of the distance from the origin to a triangle. If the foot of the perpendicular lies inside, this is the
 * distance to the plane. Otherwise it is the distance to the nearest edge. */
static double square_to_triangle(double c[3][3]) {
    double e[3][3], n[3], out[3];
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) e[k][axis] = c[(k + 1) % 3][axis] - c[k][axis];
    fibrad_cross(e[0], e[1], n);
    const double square = fibrad_dot(n, n), height = fibrad_dot(n, c[0]);
    bool inside = square > 0;
    for (int k = 0; k < 3 && inside; k++) {
        fibrad_cross(e[k], n, out);
        inside = fibrad_dot(out, c[k]) >= 0;
    }
    if (inside) return height * height / square;
    return fibrad_min(square_to_segment(c[0], c[1]),
                      fibrad_min(square_to_segment(c[1], c[2]), square_to_segment(c[2], c[0])));
}

/* Enters a node. Visits the boxes that are nearer than a length to a place, both in units of boxes, the nearest
 * first. */
static void enter_near(const fibrad_mesh *mesh, fibrad_mesh_walk *walk, uint32_t number, const double place[3],
                       double length) {
    const fibrad_mesh_node *node = &mesh->node[number];
    float square[FIBRAD_MESH_WIDE];
    uint32_t boxes = 0;
    for (uint32_t k = 0; k < FIBRAD_MESH_WIDE; k++) {
        double sum = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double from = fibrad_abs(place[axis] - (double)node->middle[axis][k]) - (double)node->half[axis][k];
            const double away = fibrad_max(0, from) / length;
            sum += away * away;
        }
        square[k] = (float)fibrad_min(sum, 1);
        boxes |= (uint32_t)(sum < 1) << k;
    }
    fibrad_mesh_enter(walk, number, boxes, square);
}

/* The least of the distance `least` and the distance from a point to the triangles of one image. */
static double nearest_in_image(const fibrad_mesh *mesh, const double at[3], double least) {
    fibrad_mesh_walk walk = {.level = 0};
    double place[3];
    for (int axis = 0; axis < 3; axis++) place[axis] = (at[axis] - mesh->middle[axis]) / mesh->extent;
    if (mesh->nodes > 0) enter_near(mesh, &walk, 0, place, least / mesh->extent);
    for (uint32_t child; fibrad_mesh_next(&walk, mesh, &child);) {
        const uint32_t first = child / 16, count = fibrad_mesh_leaf(child);
        for (uint32_t t = first; t < first + count; t++) {
            double c[3][3];
            for (int corner = 0; corner < 3; corner++)
                for (int axis = 0; axis < 3; axis++)
                    c[corner][axis] = (mesh->corner[corner][axis][t] - at[axis]) / least;
            const double ratio = square_to_triangle(c);
            if (ratio < 1) least *= fibrad_max(fibrad_sqrt(ratio), 1e-12);
        }
        if (count == 0) enter_near(mesh, &walk, first, place, least / mesh->extent);
    }
    return least;
}

double fibrad_mesh_distance(const fibrad_mesh *mesh, const double point[3], double most) {
    double low[3], high[3], least = most;
    for (int axis = 0; axis < 3; axis++) { /* the nearest image of a point is at most half a period away */
        const double half = 0.5001 * mesh->period[axis] + mesh->grain,
                     away = half > mesh->grain ? fibrad_min(most, half) : most;
        low[axis] = point[axis] - away, high[axis] = point[axis] + away;
    }
    const fibrad_mesh_images images = fibrad_mesh_images_in(mesh, low, high);
    for (int64_t z = images.first[2]; z <= images.last[2]; z++)
        for (int64_t y = images.first[1]; y <= images.last[1]; y++)
            for (int64_t x = images.first[0]; x <= images.last[0]; x++) {
                const double at[3] = {point[0] - (double)x * mesh->period[0], point[1] - (double)y * mesh->period[1],
                                      point[2] - (double)z * mesh->period[2]};
                least = nearest_in_image(mesh, at, least);
            }
    return least * (1 - 1e-9);
}
