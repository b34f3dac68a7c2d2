/* matrix.c - puts rows together into one matrix, which is reciprocal and closed. SPDX-License-Identifier: MIT
 *
 * The rows stay in their collections. The matrix knows where each row is. Tasks average ranges of rows. Then these
 * are moved together, and the row sums are corrected. docs/methods.md section 5. */
#include "matrix/matrix.h"

#define TASKS_MAX 1024u

/* The two estimates of S_ij, from rows i and j, differ by about twice the error of their mean. The factors cover all
 * but one row of a hundred: docs/accuracy.md. */
#define VIEW_ERROR     1.6
#define EXCHANGE_ERROR 1.2
#define RAW_ERROR      5.0   /* the change of raw rows along lines over their error: all of 27,000 rows are below it */
#define LEAST_ERROR    1e-12 /* least change of a row that is compared with its error; smaller changes are rounding */

/* The number of rows of a matrix. */
static uint32_t rows_of(const fibrad_scene *scene, const fibrad_matrix_rule *rule) {
    return rule->bodies > 0 ? rule->bodies : scene->facts.spheres;
}

static bool matrix_rule_valid(const fibrad_scene *scene, const fibrad_matrix_rule *rule) {
    const bool exchange = rule->kind == FIBRAD_ROWS_EXCHANGE;
    for (uint32_t b = 0; b < rule->bodies; b++)
        if (rule->area == NULL || !(rule->area[b] > 0 && fibrad_finite(rule->area[b]))) return false;
    if (rule->kind < FIBRAD_ROWS_AREAS || rule->kind > FIBRAD_ROWS_EXCHANGE) return false;
    if (rule->emissivity != NULL ? !exchange : exchange && scene->facts.spheres > 0) return false;
    if (rule->tasks > TASKS_MAX || !(rule->drop >= 0 && rule->drop <= 1)) return false;
    for (uint32_t b = 0; b < scene->facts.walls && rule->wall_row != NULL; b++) {
        const fibrad_wall_row *row = &rule->wall_row[b];
        if (!fibrad_finite(scene->wall_area[scene->slot[b]])) continue;
        if (rule->wall_emissivity != NULL && !(rule->wall_emissivity[b] >= 0 && rule->wall_emissivity[b] <= 1))
            return false;
        bool valid = row->escaped >= 0 && fibrad_finite(row->escaped) && row->error >= 0 && fibrad_finite(row->error);
        for (uint32_t c = 0; c < scene->facts.walls; c++)
            valid = valid && fibrad_finite(row->wall[c]); /* values of what a deep bed hides may be slightly negative */
        if (!valid) return false;
    }
    for (uint32_t i = 0; i < rows_of(scene, rule) && rule->emissivity != NULL; i++)
        if (!(rule->emissivity[i] >= 0 && rule->emissivity[i] <= 1)) return false;
    return true;
}

/* Whether all entries of a row are between spheres that emit. */
static bool entries_emit(const fibrad_record *row, const double *emissivity) {
    const uint32_t *col = fibrad_record_col(row);
    bool emit = row->length == 0 || emissivity[row->sphere] > 0;
    for (uint32_t k = 0; k < row->length && emit; k++) emit = emissivity[col[k]] > 0;
    return emit;
}

/* The number of all entries of the collections. UINT64_MAX: their rows belong to walls other than those of the
 * scene, or they have entries that the emissivities exclude. emissivity NULL: none. *lines: out: whether all rows are
 * along lines. */
static uint64_t entries_of(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                           const fibrad_matrix_rule *rule, bool *lines) {
    const double *emissivity = rule->emissivity;
    const uint32_t n = rows_of(scene, rule);
    uint64_t entries = 0;
    *lines = true;
    for (uint32_t c = 0; c < count; c++) {
        size_t at = 0;
        for (const fibrad_record *row; (row = fibrad_rows_next(&rows[c], &at)) != NULL; entries += row->length) {
            const uint32_t *col = fibrad_record_col(row);
            if (row->sphere >= n || row->walls != scene->facts.walls) return UINT64_MAX;
            if (row->length > 0 && col[row->length - 1] >= n) return UINT64_MAX;
            if (emissivity != NULL && !entries_emit(row, emissivity)) return UINT64_MAX;
            *lines = *lines && row->lines > 0;
        }
    }
    return entries;
}

/* Takes the arrays from the arena. The caller copies the object itself to the address returned. */
static fibrad_matrix *matrix_layout(fibrad_arena *arena, fibrad_matrix *m) {
    fibrad_matrix *place = fibrad_arena_take(arena, 1, sizeof *place);
    const size_t n = m->result.n;
    m->result.start = fibrad_arena_take(arena, n + 1, sizeof *m->result.start);
    m->result.col = fibrad_arena_take(arena, (size_t)m->result.capacity, sizeof *m->result.col);
    m->result.f = fibrad_arena_take(arena, (size_t)m->result.capacity, sizeof *m->result.f);
    m->row = fibrad_arena_take(arena, n, sizeof(void *));
    fibrad_arena_doubles(arena, n, (double **const[]){&m->escaped, &m->beyond, &m->error, &m->r, NULL});
    m->wall = fibrad_arena_take(arena, n * m->walls, sizeof *m->wall);
    m->between = fibrad_arena_take(arena, m->enclosed ? m->walls * m->walls : 0, sizeof *m->between);
    const size_t enclosed = m->enclosed ? m->walls : 0;
    fibrad_arena_doubles(arena, enclosed, (double **const[]){&m->wall_escaped, &m->wall_error, NULL});
    fibrad_arena_doubles(arena, enclosed * (m->walls + 1), (double **const[]){&m->newton, &m->before, NULL});
    m->radius = fibrad_arena_take(arena, m->sampled ? n : 0, sizeof *m->radius);
    fibrad_arena_doubles(arena, m->raw ? 0 : n, (double **const[]){&m->area, &m->noise, NULL});
    m->variance = fibrad_arena_take(arena, m->lines ? n : 0, sizeof *m->variance);
    const size_t halves = m->lines ? (size_t)m->result.capacity : 0;
    m->result.half = fibrad_arena_take(arena, halves, sizeof *m->result.half);
    m->place = fibrad_arena_take(arena, n, sizeof *m->place);
    m->scratch = fibrad_arena_take(arena, m->raw ? 0 : 3 * n, sizeof *m->scratch);
    m->part = fibrad_arena_take(arena, m->raw ? 0 : m->tasks, sizeof *m->part);
    return place;
}

/* Sets the numbers that follow from the arguments. False: an argument is not valid. */
static bool matrix_dimension(fibrad_matrix *m, const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                             const fibrad_matrix_rule *given) {
    const fibrad_matrix_rule rule = given != NULL ? *given : (fibrad_matrix_rule){0};
    if ((rows == NULL && count > 0) || !matrix_rule_valid(scene, &rule)) return false;
    bool lines;
    const uint64_t entries = entries_of(scene, rows, count, &rule, &lines);
    *m = (fibrad_matrix){.walls = scene->facts.walls, .tasks = rule.raw || rule.tasks == 0 ? 1 : rule.tasks};
    m->raw = rule.raw != 0;
    m->exchange = rule.kind == FIBRAD_ROWS_EXCHANGE;
    m->sampled = rule.kind != FIBRAD_ROWS_AREAS;
    m->lines = lines && !m->raw && !m->sampled;
    m->enclosed = rule.wall_row != NULL, m->bodies = rule.bodies > 0;
    m->drop = rule.drop, m->parallel = rule.parallel, m->context = rule.context;
    m->result.n = rows_of(scene, &rule);
    m->result.capacity = m->raw ? entries : 2 * entries + (m->drop > 0 ? m->result.n : 0);
    return entries < UINT64_MAX / 4 && m->result.capacity <= SIZE_MAX;
}

/* The number of bytes of a matrix with these numbers. */
static size_t matrix_bytes(fibrad_matrix fields) {
    fibrad_arena arena = {0};
    matrix_layout(&arena, &fields);
    return fibrad_arena_total(&arena);
}

size_t fibrad_matrix_size(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                          const fibrad_matrix_rule *rule) {
    fibrad_matrix fields;
    const bool valid = fibrad_scene_ready(scene) && matrix_dimension(&fields, scene, rows, count, rule);
    return valid ? matrix_bytes(fields) : 0;
}

/* The sum of the numbers of changes of the collections. */
static uint64_t serial_of(const fibrad_rows *rows, uint32_t count) {
    uint64_t serial = 0;
    for (uint32_t c = 0; c < count; c++) serial += rows[c].serial;
    return serial;
}

/* Whether the matrix exists and its rows have not changed. */
static bool matrix_open(const fibrad_matrix *m) {
    return m->open && !m->closed && serial_of(m->given, m->given_count) == m->given_serial;
}

/* Finds the row of each sphere. FIBRAD_E_STATE: a row is missing, exists twice, or belongs to another scene. */
static int find_rows(fibrad_matrix *m, const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                     uint32_t *sphere) {
    const uint32_t n = m->result.n;
    for (uint32_t i = 0; i < n; i++) m->row[i] = NULL;
    for (uint32_t c = 0; c < count; c++) {
        size_t at = 0;
        for (const fibrad_record *row; (row = fibrad_rows_next(&rows[c], &at)) != NULL; m->row[row->sphere] = row) {
            if (m->row[row->sphere] == NULL && (row->scene == 0 || row->scene == scene->hash)) continue;
            if (sphere != NULL) *sphere = row->sphere;
            return FIBRAD_E_STATE;
        }
    }
    for (uint32_t i = 0; i < n && !m->raw; i++)
        if (m->row[i] == NULL) {
            if (sphere != NULL) *sphere = i;
            return FIBRAD_E_STATE;
        }
    return FIBRAD_OK;
}

/* Copies what a row has besides its entries. If the row is missing: zeros. */
static void copy_rest(fibrad_matrix *m, uint32_t i) {
    const fibrad_record *row = m->row[i];
    m->escaped[i] = row != NULL ? row->escaped : 0;
    m->beyond[i] = row != NULL ? row->beyond : 0;
    m->error[i] = row != NULL ? row->error : 0;
    double *wall = m->wall + (size_t)i * m->walls;
    for (uint32_t b = 0; b < m->walls; b++) wall[b] = row != NULL ? fibrad_record_wall(row)[b] : 0;
}

/* Copies the rows in order. */
static void copy_raw(fibrad_matrix *m) {
    fibrad_sparse *to = &m->result;
    to->start[0] = 0;
    for (uint32_t i = 0; i < to->n; i++) {
        const fibrad_record *row = m->row[i];
        const uint32_t length = row != NULL ? row->length : 0;
        copy_rest(m, i);
        to->start[i + 1] = to->start[i] + length;
        if (length == 0) continue;
        fibrad_copy(to->col + to->start[i], fibrad_record_col(row), length * sizeof *to->col);
        fibrad_copy(to->f + to->start[i], fibrad_record_f(row), length * sizeof *to->f);
    }
}

static void measure_part(void *matrix, uint32_t p) {
    fibrad_matrix *m = matrix;
    fibrad_matrix_part *part = &m->part[p];
    for (uint32_t i = part->begin; i < part->end; i++) copy_rest(m, i), part->transposed += m->row[i]->length;
    part->last = part->transposed + fibrad_matrix_count_part(m, part);
}

/* Divides the rows into parts with about as many entries each. A part has a range of the result for its rows of the
 * matrix and of the transpose. */
static void divide(fibrad_matrix *m, uint64_t entries) {
    const uint32_t n = m->result.n;
    uint64_t own = 0, at = 0;
    uint32_t i = 0;
    for (uint32_t p = 0; p < m->tasks; p++) {
        const uint64_t until = entries / m->tasks * (p + 1);
        m->part[p] = (fibrad_matrix_part){.begin = i};
        for (; i < n && (own < until || p + 1 == m->tasks); i++) own += m->row[i]->length;
        m->part[p].end = i;
    }
    fibrad_matrix_share(m, m->tasks, measure_part, m);
    for (uint32_t p = 0; p < m->tasks; p++) { /* each range begins where the last one ends */
        fibrad_matrix_part *part = &m->part[p];
        part->first = at, part->transposed += at;
        part->last = at += part->last;
    }
}

int fibrad_matrix_init(fibrad_matrix **out, void *memory, size_t size, const fibrad_scene *scene,
                       const fibrad_rows *rows, uint32_t count, const fibrad_matrix_rule *rule, uint32_t *sphere) {
    fibrad_matrix fields;
    fibrad_arena arena;
    if (out == NULL || scene == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    for (uint32_t c = 0; c < count && rows != NULL; c++)
        if (!fibrad_rows_settled(&rows[c])) return FIBRAD_E_STATE;
    if (!matrix_dimension(&fields, scene, rows, count, rule)) return FIBRAD_E_ARGUMENT;
    int status = fibrad_arena_open(&arena, memory, size, matrix_bytes(fields));
    if (status != FIBRAD_OK) return status;
    fibrad_matrix *m = matrix_layout(&arena, &fields);
    *m = fields;
    status = find_rows(m, scene, rows, count, sphere);
    if (status != FIBRAD_OK) return status;
    double largest = 0;
    for (uint32_t i = 0; i < m->result.n; i++) {
        m->r[i] =
            rule != NULL && rule->bodies > 0 ? fibrad_sqrt(rule->area[i] / (4 * FIBRAD_PI)) : scene->r[scene->place[i]];
        if (m->sampled) m->radius[i] = m->r[i];
        if (m->exchange) m->r[i] *= fibrad_sqrt(rule->emissivity[i]);
        largest = fibrad_max(largest, m->r[i]);
    }
    for (uint32_t i = 0; i < m->result.n && !m->raw; i++) {
        const double ratio = largest > 0 ? m->r[i] / largest : 0;
        m->area[i] = ratio * ratio, m->noise[i] = __builtin_inf();
        if (m->lines) m->variance[i] = m->row[i]->noise * m->row[i]->noise;
    }
    if (m->enclosed) fibrad_matrix_take_walls(m, scene, rule);
    if (m->raw)
        copy_raw(m);
    else
        divide(m, (m->result.capacity - (m->drop > 0 ? m->result.n : 0)) / 2);
    m->given = rows, m->given_count = count, m->given_serial = serial_of(rows, count);
    m->open = true;
    *out = m;
    return FIBRAD_OK;
}

static void average_part(void *matrix, uint32_t p) {
    fibrad_matrix *m = matrix;
    fibrad_matrix_average_part(m, &m->part[p]);
}

/* Parts that are moved at the same time. */
struct moved_parts {
    const fibrad_sparse *rows;
    const fibrad_matrix_part *part;
};

static void move_part(void *moved, uint32_t p) {
    const struct moved_parts *parts = moved;
    const fibrad_sparse *rows = parts->rows;
    const fibrad_matrix_part *part = &parts->part[p];
    const size_t length = (size_t)(part->filled - part->first);
    __builtin_memmove(rows->col + part->to, rows->col + part->first, length * sizeof *rows->col);
    __builtin_memmove(rows->f + part->to, rows->f + part->first, length * sizeof *rows->f);
    for (uint32_t i = part->begin; i < part->end; i++) rows->start[i] -= part->first - part->to;
}

/* Moves the averaged parts together. Parts are moved at the same time if they end before the first of them begins. */
static void gather_parts(fibrad_matrix *m) {
    fibrad_sparse *rows = &m->result;
    uint64_t to = 0;
    for (uint32_t p = 0; p < m->tasks; p++) {
        m->part[p].to = to;
        to += m->part[p].filled - m->part[p].first;
    }
    for (uint32_t p = 0, end; p < m->tasks; p = end) {
        for (end = p + 1; end < m->tasks; end++)
            if (m->part[end].to + (m->part[end].filled - m->part[end].first) > m->part[p].first) break;
        fibrad_matrix_share(m, end - p, move_part, &(struct moved_parts){rows, m->part + p});
    }
    rows->start[rows->n] = to;
}

/* Divides `rest` among all that row i meets besides spheres, in proportion to what the row has of each. If it has
 * nothing of that, in the proportions of all spheres together. */
static void share_out(fibrad_matrix *m, uint32_t i, double rest) {
    const double *all = m->all;
    double *wall = m->wall + (size_t)i * m->walls, sum = 0, total = 0;
    for (uint32_t b = 0; b < m->walls; b++) sum += wall[b], total += all[b];
    sum += m->escaped[i], total += all[m->walls];
    sum += m->beyond[i], total += all[m->walls + 1];
    const bool own = sum > 0;
    if (!own) sum = total;
    for (uint32_t b = 0; b < m->walls; b++) wall[b] = sum > 0 ? rest * ((own ? wall[b] : all[b]) / sum) : 0;
    m->escaped[i] = sum > 0 ? rest * ((own ? m->escaped[i] : all[m->walls]) / sum) : rest;
    m->beyond[i] = sum > 0 ? rest * ((own ? m->beyond[i] : all[m->walls + 1]) / sum) : 0;
}

static void close_part(void *matrix, uint32_t p) {
    fibrad_matrix *m = matrix;
    for (uint32_t i = m->part[p].begin; i < m->part[p].end; i++)
        if (m->r[i] > 0) share_out(m, i, fibrad_max(0, 1 - fibrad_sparse_sum(&m->result, i)));
}

/* Increases what rows meet besides spheres to 1 minus the row sum. This difference comes from the opposite
 * directions and is as good a measure as the raw row's. Rows of spheres that reflect all stay empty. */
static void close_rows(fibrad_matrix *m) {
    double *all = m->all;
    const uint32_t n = m->result.n, walls = m->walls;
    for (uint32_t i = 0; i < n; i++) {
        const double area = m->area[i];
        for (uint32_t b = 0; b < walls; b++) all[b] += area * m->wall[(size_t)i * walls + b];
        all[walls] += area * m->escaped[i], all[walls + 1] += area * m->beyond[i];
    }
    fibrad_matrix_share(m, m->tasks, close_part, m);
}

/* How much of a row, besides its factors to spheres, differs from the raw row. */
static double change_of(const fibrad_matrix *m, uint32_t i) {
    const fibrad_record *raw = m->row[i];
    const double *wall = m->wall + (size_t)i * m->walls, *before = fibrad_record_wall(raw);
    const double escaped = m->escaped[i] - raw->escaped, beyond = m->beyond[i] - raw->beyond;
    double square = escaped * escaped + beyond * beyond;
    for (uint32_t b = 0; b < m->walls; b++) square += (wall[b] - before[b]) * (wall[b] - before[b]);
    return fibrad_sqrt(square);
}

/* Compares the change of a row with an error. */
static void note_change(const fibrad_matrix *m, fibrad_matrix_part *part, uint32_t i, double error) {
    const double changed = change_of(m, i) / fibrad_max(error, LEAST_ERROR);
    if (changed > part->worst) part->worst = changed, part->worst_row = i;
}

/* The distance between a row and its raw row. The columns of the raw row are among those of the row. If a raw row says
 * little about another sphere, as that of a large sphere about a small one, its difference counts by the ratio of both
 * weights in the mean. *own: out: the part of the row that comes from the raw row. */
static double distance_to_raw(const fibrad_matrix *m, uint32_t i, double *own) {
    const fibrad_record *raw = m->row[i];
    const uint32_t *col = fibrad_record_col(raw);
    const double *f = fibrad_record_f(raw);
    double square = 0, sum = 0, part = 0;
    uint32_t p = 0;
    for (uint64_t k = m->result.start[i]; k < m->result.start[i + 1]; k++) {
        const uint32_t j = m->result.col[k];
        const double mean = m->result.f[k], own_part = j == i ? 1 : fibrad_matrix_own(m, i, j);
        const double difference = mean - (p < raw->length && col[p] == j ? f[p++] : 0);
        square += fibrad_min(1, own_part / (1 - own_part)) * (difference * difference);
        part += own_part * mean, sum += mean;
    }
    *own = sum > 0 ? part / sum : 0.5;
    return fibrad_sqrt(square);
}

/* Estimates the error of a row that is not along lines, from the distance to the raw row. It is at least that of the
 * raw row, as far as the mean comes from the row itself: by symmetry the errors of two rows may be equal. For the
 * shares of walls the error is that of the raw row, in proportion to what the walls get. */
static double error_of_mean(const fibrad_matrix *m, uint32_t i) {
    double met = 0, own;
    const double distance = distance_to_raw(m, i, &own);
    for (uint32_t b = 0; b < m->walls; b++) met += m->wall[(size_t)i * m->walls + b];
    if (m->bodies) own = 1; /* most of the error is of what passes inside, which no mean makes smaller */
    if (!m->exchange) return fibrad_max(VIEW_ERROR * distance, (own + (1 - own) * met) * m->error[i]);
    /* of paths: the square of the error is in proportion to what they find, and no mean changes walls and the open */
    const double ends = fibrad_min(1, met + m->escaped[i] + m->beyond[i]), raw = m->error[i] * m->error[i];
    const double spheres = fibrad_max(EXCHANGE_ERROR * distance, own * fibrad_sqrt((1 - ends) * raw));
    return fibrad_sqrt(spheres * spheres + ends * raw);
}

/* The error with which the change of a row is compared. A raw row along lines looks along one sense of each line. */
static double error_of_change(const fibrad_matrix *m, uint32_t i) {
    return m->lines ? fibrad_max(m->error[i], RAW_ERROR * m->row[i]->error) : m->error[i];
}

static void estimate_errors(void *matrix, uint32_t part) {
    fibrad_matrix *m = matrix;
    m->part[part].worst = 0;
    for (uint32_t i = m->part[part].begin; i < m->part[part].end; i++) {
        if (!m->lines && m->row[i]->symmetric) continue;
        if (!m->lines) m->error[i] = error_of_mean(m, i);
        note_change(m, &m->part[part], i, error_of_change(m, i));
    }
}

/* Finds the row that closing has changed most in comparison with its error. */
static void find_changed(fibrad_matrix *m) {
    for (uint32_t p = 0; p < m->tasks; p++)
        if (m->part[p].worst > m->changed) m->changed = m->part[p].worst, m->changed_row = m->part[p].worst_row;
}

int fibrad_matrix_close(fibrad_matrix *m) {
    if (m == NULL) return FIBRAD_E_ARGUMENT;
    if (!matrix_open(m)) return FIBRAD_E_STATE;
    m->closed = true;
    if (m->raw) return FIBRAD_OK;
    fibrad_matrix_share(m, m->tasks, average_part, m);
    gather_parts(m);
    fibrad_matrix_balance(m);
    close_rows(m);
    if (m->enclosed) fibrad_matrix_enclose(m);
    fibrad_matrix_share(m, m->tasks, estimate_errors, m);
    find_changed(m);
    if (m->drop > 0) fibrad_matrix_drop(m);
    return FIBRAD_OK;
}

int fibrad_matrix_read(const fibrad_matrix *m, fibrad_factors *factors) {
    if (m == NULL || factors == NULL) return FIBRAD_E_ARGUMENT;
    if (!m->closed) return FIBRAD_E_STATE;
    *factors = (fibrad_factors){.n = m->result.n, .walls = m->walls, .start = m->result.start, .col = m->result.col};
    factors->f = m->result.f, factors->escaped = m->escaped, factors->beyond = m->beyond, factors->error = m->error;
    factors->wall = m->wall, factors->changed = m->changed, factors->changed_row = m->changed_row;
    if (!m->enclosed) return FIBRAD_OK;
    factors->wall_wall = m->between;
    factors->wall_escaped = m->wall_escaped;
    factors->wall_error = m->wall_error;
    factors->wall_correction = m->correction;
    factors->wall_closure = m->wall_closure;
    return FIBRAD_OK;
}

/* The difference between A_i F_ij and A_j F_ji over the larger area. It is the same from both sides. */
static double difference_of(const double *r, uint32_t i, uint32_t j, double f, double back) {
    double larger = fibrad_max(r[i], r[j]), a_i = r[i] / larger, a_j = r[j] / larger;
    return fibrad_abs(a_i * a_i * f - a_j * a_j * back);
}

/* The partner of entry (i, j), j >= i, is the next one of row j. Entries of row j that are passed over have none. */
static double compare_with_partner(const fibrad_matrix *m, uint32_t i, uint64_t k) {
    const fibrad_sparse *rows = &m->result;
    const uint32_t j = rows->col[k];
    uint64_t *next = &m->place[j];
    double worst = 0;
    for (; *next < rows->start[j + 1] && rows->col[*next] < i; ++*next)
        worst = fibrad_max(worst, difference_of(m->r, j, rows->col[*next], rows->f[*next], 0));
    const bool found = *next < rows->start[j + 1] && rows->col[*next] == i;
    const double back = found ? rows->f[(*next)++] : 0;
    return fibrad_max(worst, difference_of(m->r, i, j, rows->f[k], back));
}

int fibrad_matrix_reciprocity(const fibrad_matrix *m, double *largest) {
    if (m == NULL || largest == NULL) return FIBRAD_E_ARGUMENT;
    if (!m->closed) return FIBRAD_E_STATE;
    const fibrad_sparse *rows = &m->result;
    *largest = 0;
    for (uint32_t i = 0; i < rows->n; i++) m->place[i] = rows->start[i];
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            if (rows->col[k] >= i) *largest = fibrad_max(*largest, compare_with_partner(m, i, k));
    for (uint32_t j = 0; j < rows->n; j++)
        for (uint64_t k = m->place[j]; k < rows->start[j + 1] && rows->col[k] < j; k++)
            *largest = fibrad_max(*largest, difference_of(m->r, j, rows->col[k], rows->f[k], 0));
    return FIBRAD_OK;
}
