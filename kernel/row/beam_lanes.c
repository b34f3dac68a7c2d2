/* beam_lanes.c - a row of view factors by parallel beams. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "sample/direction.h"
#include "row/beam.h"
#include "pair/free_pair.h"
#include "workspace/segments_lanes.h"
#include "row/mesh_share_lanes.h"
#include "row/wall_share_lanes.h"
#include "row/window_lanes.h"
#include "mask/line_set.h"
#include "window/clip_lanes.h"
#include "mask/masks_lanes.h"

#define FEW_POINTS  64u /* of windows of rows with few windows */
#define WALL_POINTS 64u /* of windows by masks that look at walls */

/* Spheres look at walls along both senses of their lines if a wall, or the border of the bed, is nearer than this, in
 * free paths. The others see little of walls. */
#define WALL_NEAR 1.2

/* Numbers of nearby directions differ by a Fibonacci number. The nearest directions belong to the least Fibonacci
 * number whose product with the next one is at least NEARBY times the number of directions. */
#define NEARBY 1.4
/* A row remembers this many windows. It is more than twice `nearby` for any number of directions. */
#define WINDOWS_RECENT 1024u

/* The windows of a row. */
typedef struct beam_windows {
    const fibrad_line_set *lines; /* NULL: directions */
    uint32_t count;
    bool turned; /* directions have been turned */
    bool both;   /* walls are also seen in the other sense of each line */
    fibrad_turning turning;
    double size;            /* of a window that has no masks: its points, or its area */
    uint32_t chords, words; /* of masks; 0: none */
    fibrad_points points;   /* count 0: exact areas */
    uint32_t nearby;        /* directions whose numbers differ by this are near each other */
    uint32_t compared;      /* number of windows that were compared with two nearby ones */
    double roughness;       /* sum of the squared differences */
    float *open;            /* [WINDOWS_RECENT], the part of each of the last windows that no sphere covers */
} beam_windows;

/* Sums over the windows of a row so far. */
typedef struct beam_sums {
    double open[2];  /* what meets nothing in even and in odd windows */
    double whole[2]; /* sizes of even and of odd windows, in points of masks or as areas */
} beam_sums;

static void LANED(frame_of_beam)(const void *from, uint32_t k, uint32_t points, double frame[9]) {
    const beam_windows *windows = from;
    if (windows->lines != NULL) {
        fibrad_copy(frame, windows->lines->frame[k % windows->count], 9 * sizeof *frame);
        for (int n = 3; n < 9 && k >= windows->count; n++) frame[n] = -frame[n];
        return;
    }
    if (windows->turned)
        fibrad_turned_frame(&windows->turning, k, windows->count, points, frame);
    else
        fibrad_beam_frame(k, windows->count, points, frame);
}

/* Error: _TABLE. */
static int choose_windows(const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule, beam_windows *windows) {
    *windows = (beam_windows){.lines = rule->lines, .count = rule->directions, .turned = rule->turn != 0};
    const int only = fibrad_walls_only(&scene->container);
    if (windows->turned) windows->turning = fibrad_turning_of(rule->turn, only < 3 ? only : 2);
    windows->words = fibrad_mask_words(scene, i);
    if (rule->chords > 0 && windows->words > 0) windows->chords = rule->chords * windows->words;
    windows->points.count = rule->points;
    windows->size = rule->points > 0 ? rule->points : FIBRAD_PI;
    uint32_t next = 2;
    for (windows->nearby = 1; windows->nearby * next < NEARBY * rule->directions;) {
        next += windows->nearby;
        windows->nearby = next - windows->nearby;
    }
    return rule->points > 0 ? fibrad_disc_points_get(rule->points, &windows->points.set) : FIBRAD_OK;
}

/* The error of a row along lines over half the difference of its halves, and the same for the shares of walls, of which
 * both halves have errors in common. Measured: docs/accuracy.md. The halves of few walls may agree by chance. Then the
 * fourths tell: tests/test_estimate.c has the scenes. */
#define LINES_ERROR      0.5
#define DIRECTIONS_ERROR 1.0 /* along directions, by masks */
#define SHARES_ERROR     0.8
#define SHARES_BOTH      0.2 /* if walls are seen in both senses */
#define SHARES_FOURTHS   0.5

/* The noise of a row from the points of masks. A window is divided into regions, the visible parts of spheres. The
 * variance of a region's area is about as its border times the cube of the distance of points (D. G. Kendall, Q. J.
 * Math. 19 (1948) 1). regions: of all windows. The factors are measured, docs/accuracy.md. */
static double noise_of(const beam_windows *windows, double points, double regions) {
    const double n = windows->count, cell = FIBRAD_PI * n / points, chords = windows->chords / windows->words;
    const double factor = chords <= 16 ? 1.37 / 14 : chords <= 32 ? 1.04 / 14 : 1.18 / 14;
    const double border = 2 * FIBRAD_PI * fibrad_sqrt(regions / n);
    return fibrad_sqrt(factor * border * cell * fibrad_sqrt(cell) / n) / FIBRAD_PI;
}

static void open_masks(fibrad_masks *masks, const beam_windows *windows, uint32_t k) {
    const fibrad_line_set *lines = windows->lines;
    if (lines == NULL || windows->words > 1 || windows->chords != lines->chords) {
        LANED(fibrad_masks_open)(masks, windows->chords, windows->words, k);
        return;
    }
    const uint32_t *word = lines->word + (size_t)k * lines->chords;
    fibrad_masks_place(masks, lines->chords, 1, k);
    for (uint32_t chord = 0; chord < lines->chords; chord += VF_LANES)
        vn_store(masks->word + chord, vn_load(word + chord));
    masks->points = masks->open = lines->points[k];
}

/* Which points of some set are open after a window by masks, if there are walls to be seen. count 0: none was asked. */
static void open_of_masks(const fibrad_workspace *work, fibrad_points *points) {
    points->count = 0;
    if (work->masks.open == 0 || !work->scene->container.walls) return;
    points->count = WALL_POINTS;
    (void)fibrad_disc_points_get(WALL_POINTS, &points->set);
    points->open = LANED(fibrad_masks_at)(&work->masks, WALL_POINTS, points->set.x, points->set.y, points->seen);
    if (points->open == 0) points->open = WALL_POINTS, points->seen[0] = UINT64_MAX;
}

/* Computes window k by masks, or by exact areas if a triangle may come before it. whole: out: the size of the window in
 * points. Returns the open part. *points: out: which points of some set are open; count 0: the discs of `work` tell. */
static double window_by_masks(fibrad_workspace *work, beam_windows *windows, const double frame[9], uint32_t k,
                              uint32_t line, double *whole) {
    fibrad_points *points = &windows->points;
    work->entries.weight = 1, work->entries.halves = false;
    open_masks(&work->masks, windows, line);
    const bool done = LANED(fibrad_mask_window)(work, frame, k);
    *whole = work->masks.points;
    if (!done) {
        points->count = 0;
        work->entries.weight = *whole / FIBRAD_PI, work->entries.halves = true;
        return LANED(fibrad_beam_window)(work, frame, points, k) * work->entries.weight;
    }
    if (work->met != NULL) work->met->any = false;
    open_of_masks(work, points);
    return work->masks.open;
}

/* Computes window k. Windows from windows->count on are those of the other senses: they add nothing to spheres. Returns
 * the open part. frame, whole: out. */
static double compute_window(fibrad_workspace *work, beam_windows *windows, uint32_t k, double frame[9],
                             double *whole) {
    fibrad_points *points = &windows->points;
    const bool masked = windows->chords > 0;
    const uint32_t adds = k < windows->count ? k : FIBRAD_NONE;
    LANED(frame_of_beam)(windows, k, masked ? 0 : points->count, frame);
    if (masked) return window_by_masks(work, windows, frame, adds, k % windows->count, whole);
    *whole = points->count > 0 ? points->count : FIBRAD_PI;
    return LANED(fibrad_beam_window)(work, frame, points, adds);
}

/* Compares what window k has open with the two nearby windows before it. If what is open changed evenly from one
 * direction to the next, the difference would be 0. open: a part of the window */
static void compare_window(beam_windows *windows, uint32_t k, double open) {
    const uint32_t once = windows->nearby, twice = 2 * windows->nearby;
    float *of = windows->open;
    of[k % WINDOWS_RECENT] = (float)open;
    if (k < twice) return;
    const double difference = open - 2 * of[(k - once) % WINDOWS_RECENT] + of[(k - twice) % WINDOWS_RECENT];
    windows->roughness += difference * difference, windows->compared++;
}

/* The error that the open part of the row would have if windows differed at random, by as much as nearby windows do.
 * docs/methods.md section 11; docs/accuracy.md compares it with errors. */
static double open_error_of(const beam_windows *windows) {
    if (windows->compared == 0) return 0;
    return fibrad_sqrt(windows->roughness / (6.0 * windows->compared * windows->count));
}

static void add_open(uint32_t k, double rest, beam_sums *sums) { sums->open[k % 2] += rest; }

/* Computes window k and adds it to all sums. False: there was no room for all discs. */
static bool add_window(fibrad_workspace *work, beam_windows *windows, const fibrad_window_set *set, uint32_t k,
                       beam_sums *sums) {
    static const double centre[3] = {0, 0, 0};
    fibrad_points *points = &windows->points;
    double frame[9], whole;
    work->entries.end = set->ends && (k == 0 || k == windows->count - 1);
    const double rest = compute_window(work, windows, k, frame, &whole);
    if (work->disc.count > work->disc.capacity || work->areas.overflow) return false;
    sums->whole[k % 2] += whole;
    LANED(take_segments)(work, frame, k, rest > 0);
    if (windows->chords == 0) compare_window(windows, k, work->bare / whole);
    const bool meets = work->met != NULL && work->met->any;
    if (meets) LANED(fibrad_mesh_count)(work, frame, k);
    if (work->scene->container.walls) LANED(fibrad_walls_share)
    (work, frame, meets && points->count == 0 ? &work->met->points : points, k, set, rest, whole);
    else if (work->cut && rest != 0 && fibrad_work_met(work, centre, frame + 6, work->reach) == FIBRAD_BEYOND)
        fibrad_work_slot(work, FIBRAD_BEYOND, rest);
    else add_open(k, rest, sums);
    if (!windows->both) return true;
    const uint32_t back = windows->count + k;
    const double rest_back = compute_window(work, windows, back, frame, &whole);
    LANED(fibrad_walls_share)(work, frame, points, back, set, rest_back, whole);
    add_open(k, rest, sums); /* what walls get in all, see keep_open */
    return work->disc.count <= work->disc.capacity && !work->areas.overflow;
}

/* The view of walls along the lines of windows. In a periodic bed whose spheres are all there a window sees the way in
 * its own direction to the end. Its lines have directions about that one. They stay near it for a length of about the
 * root of the number of windows, in radii. From there on the occupancy tells whether they meet spheres, as beyond a
 * cutoff. */
static fibrad_wall_view view_of_lines(const fibrad_workspace *work, uint32_t windows) {
    const double *period = work->scene->period;
    const bool repeats = period[0] > 0 || period[1] > 0 || period[2] > 0;
    const bool marked =
        !work->cut && repeats && work->scene->occupancy.mark != NULL && fibrad_walls_only(&work->scene->container) == 3;
    return fibrad_wall_view_of(work->scene, work->place, work->cut || marked,
                               marked ? fibrad_sqrt(windows) : work->reach);
}

/* Adds the points that the near list has counted to the entries. Those of odd windows go to part 3, all others to
 * part 2. */
static void gather_counts(fibrad_workspace *work) {
    const fibrad_near *near = &work->near;
    fibrad_entries *entries = &work->entries;
    entries->weight = 1, entries->end = entries->halves = false;
    for (uint32_t k = 0, end = near->shells > 0 ? near->end[near->shells - 1] : 0; k < end; k++) {
        if ((near->count[k][0] | near->count[k][1]) == 0) continue;
        const uint32_t entry = fibrad_entries_of(entries, near->sphere[k]);
        for (uint32_t half = 0; half < 2; half++) fibrad_entries_add(entries, entry, 2 + half, near->count[k][half]);
    }
}

/* Whether the sphere is near a wall, or near the border of the bed, from where it sees walls far away. */
static bool near_walls(const fibrad_workspace *work) {
    const fibrad_scene *scene = work->scene;
    double near = fibrad_wall_nearest(&work->walls->view);
    for (int axis = 0; axis < 3; axis++) {
        if (scene->period[axis] > 0) continue;
        const double border = fibrad_min(work->centre[axis] - scene->low[axis], scene->high[axis] - work->centre[axis]);
        near = fibrad_min(near, 1 + border * work->inverse);
    }
    return near < 1 + WALL_NEAR * work->free_path;
}

/* Walls share what is open in the windows that spheres share, too. The windows of the other senses only change the
 * proportions. parts: as in fibrad_wall_factors. */
static void keep_open(fibrad_workspace *work, beam_sums *sums, double parts[2]) {
    double all = 0;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) all += work->wall[slot];
    const double scale = all > 0 ? (sums->open[0] + sums->open[1]) / all : 0;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) work->wall[slot] *= scale;
    parts[0] *= scale * scale, parts[1] *= scale * scale;
    sums->open[0] = sums->open[1] = 0;
}

/* Begins a row. Rows of 64 points have so few windows that directions of lines would spread widely. The open part of a
 * window does not follow them that far. Factors of walls would be too large by up to 1.5 % at 14 windows. If such rows
 * are turned at random, parallel lines have no bias. */
static void begin_row(fibrad_workspace *work, const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule,
                      beam_windows *windows) {
    work->areas.overflow = false;
    work->areas.fallbacks = 0;
    work->windows = windows->count;
    work->masks.regions = 0;
    fibrad_work_begin(work, scene, scene->place[i], rule->cutoff, FIBRAD_BEAM_STRIDE);
    work->entries.masked = windows->chords > 0;
    work->parallel = windows->turned && rule->points == FEW_POINTS;
    work->turned = windows->turned;
    if (!scene->container.walls) return;
    work->walls->view = view_of_lines(work, windows->count);
    windows->both = windows->lines != NULL && scene->mesh.triangles == 0 && near_walls(work);
    fibrad_wall_sums_begin(&work->walls->sums, windows->count << windows->both);
}

/* What the windows of a row have in common. */
static fibrad_window_set set_of_windows(const beam_windows *windows) {
    const bool masked = windows->chords > 0;
    return (fibrad_window_set){.frame = LANED(frame_of_beam),
                               .from = windows,
                               .directions = windows->count << windows->both,
                               .whole = masked ? FIBRAD_PI * 8 * windows->words * windows->chords : windows->size,
                               .ends = windows->lines == NULL && !masked};
}

/* Adds up all windows. Errors: _WORK, _BACK. */
static int sum_windows(fibrad_workspace *work, beam_windows *windows, const fibrad_window_set *set, beam_sums *sums) {
    LANED(begin_segments)(&work->segments);
    for (uint32_t k = 0; k < windows->count; k++)
        if (!add_window(work, windows, set, k, sums)) return fibrad_work_discs_missed(work);
    if (windows->chords > 0) gather_counts(work);
    if (work->entries.missed > 0) return fibrad_work_entries_missed(work);
    return work->back != UINT32_MAX ? FIBRAD_E_BACK : FIBRAD_OK;
}

/* Sets what the row has besides spheres. parts: out: as in fibrad_wall_factors. */
static void give_rest(fibrad_workspace *work, const beam_windows *windows, const fibrad_window_set *set,
                      beam_sums *sums, const fibrad_free_pairs *pairs, double scale, double parts[2], fibrad_row *row) {
    const fibrad_scene *scene = work->scene;
    if (scene->container.walls) LANED(fibrad_walls_complete)(work, set, parts);
    if (windows->both) keep_open(work, sums, parts);
    fibrad_entries_slots(&work->entries, scene, work->wall);
    row->escaped = (sums->open[0] + sums->open[1] + work->wall[FIBRAD_ESCAPED]) * scale;
    row->beyond = work->wall[FIBRAD_BEYOND] * scale;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++)
        if (fibrad_slot_of_wall(slot)) work->wall[slot] = fibrad_max(0, work->wall[slot]) * scale;
    fibrad_free_pairs_share(pairs, work->wall, row);
    fibrad_row_cut(scene, work->place, work->wall, row);
    fibrad_row_walls(scene, work->wall, row);
}

/* Sets the error of a row along lines or by masks, from that of the difference of its halves. */
static void set_error_of_halves(const fibrad_workspace *work, double gain, fibrad_row *row) {
    if (row->half != NULL) fibrad_weigh_halves(work, row);
    const double areas = fibrad_max(0, row->error * row->error - row->noise * row->noise);
    row->error = fibrad_sqrt(gain * gain * areas + row->noise * row->noise + row->shares * row->shares);
}

/* Sets the error of a row along directions by exact areas or points. unseen: as in fibrad_free_pairs */
static void set_error_of_directions(const fibrad_workspace *work, const double parts[2], double unseen, double scale,
                                    fibrad_row *row) {
    if (parts[0] > 0) row->error = fibrad_sqrt(row->error * row->error + parts[0] * scale * scale);
    row->error = fibrad_entries_error(&work->entries, parts, row->error, scale);
    if (unseen > 0) row->error = fibrad_sqrt(row->error * row->error + unseen * unseen);
}

int LANED(fibrad_beam_lanes)(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                             const fibrad_beam_rule *rule, bool exact, fibrad_row *row) {
    beam_windows windows;
    float open[WINDOWS_RECENT];
    beam_sums sums = {{0, 0}, {0, 0}};
    double parts[2] = {0, 0};
    int status = choose_windows(scene, scene->place[i], rule, &windows);
    if (status != FIBRAD_OK) return status;
    windows.open = open;
    const bool masked = windows.chords > 0, lines = windows.lines != NULL;
    begin_row(work, scene, i, rule, &windows);
    const fibrad_window_set set = set_of_windows(&windows);
    status = sum_windows(work, &windows, &set, &sums);
    if (status != FIBRAD_OK) return status;
    row->fallbacks = work->areas.fallbacks;
    row->length = 0;
    const double all = sums.whole[0] + sums.whole[1], scale = masked ? 1 / all : 1 / (windows.count * windows.size);
    for (int half = 0; half < 2 && lines; half++) work->entries.balance[half] = all / (2 * sums.whole[half]);
    fibrad_free_pairs pairs = {.open = 1};
    if (exact) pairs = fibrad_free_pairs_find(work, scale, work->segments.length == 0);
    if (work->entries.missed > 0) return fibrad_work_entries_missed(work);
    status = fibrad_free_pairs_segments(work, &pairs);
    if (status == FIBRAD_OK) status = fibrad_entries_row(&work->entries, scene, scale, row);
    if (status != FIBRAD_OK) return status;
    give_rest(work, &windows, &set, &sums, &pairs, scale, parts, row);

    const bool halves = lines || scene->clump != NULL; /* errors of members cancel in the row of a clump */
    if (!halves) row->half = NULL;
    row->directions = halves ? 0 : windows.count;
    row->lines = halves ? windows.count : 0;
    row->symmetric = 0;
    row->noise = masked ? noise_of(&windows, all, work->masks.regions) : 0;
    const double shares = (windows.both ? SHARES_BOTH : SHARES_ERROR) *
                          fibrad_sqrt(fibrad_max(parts[0], SHARES_FOURTHS * parts[1])) * scale;
    row->shares = fibrad_sqrt(shares * shares + pairs.unseen * pairs.unseen);
    work->open_error = open_error_of(&windows);
    if (lines || masked)
        set_error_of_halves(work, lines ? LINES_ERROR : DIRECTIONS_ERROR, row);
    else
        set_error_of_directions(work, parts, pairs.unseen, scale, row);
    return fibrad_row_checked(scene, row);
}
