/* test_couple.c - messages, links, rows and powers over MPI, against one rank and against the kernel alone, on any
 * number of ranks. SPDX-License-Identifier: MIT
 *
 * test_couple FOLDER: files of rows go into FOLDER. Rank 0 alone makes the rows of whole beds on MPI_COMM_SELF.
 * These rows do not depend on the number of ranks, so all runs have the same reference. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "couple/insitu.h"
#include "couple/ranks/ranks.h"
#include "couple/rows_file.h"

static int rank, ranks, checks, failures;
static const char *folder;

#define CHECK(holds)                                                                                                   \
    do {                                                                                                               \
        ++checks;                                                                                                      \
        if (!(holds)) ++failures, fprintf(stderr, "rank %d, line %d: %s\n", rank, __LINE__, #holds);                   \
    } while (0)

static uint64_t hash_of(uint64_t a, uint64_t b) {
    uint64_t z = (a * 0x9e3779b97f4a7c15u) ^ (b + 0x632be59bd9b4e019u);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static double random_of(uint64_t a, uint64_t b) { return (double)(hash_of(a, b) >> 11) * 0x1p-53; }

static void *memory_of(size_t count, size_t size) {
    void *block = calloc(count + 1, size);
    if (!block) MPI_Abort(MPI_COMM_WORLD, 1);
    return block;
}

/* Variables that free what they have at the end of their block. */
#define FREED        __attribute__((cleanup(free_block)))
#define OWNED_INSITU __attribute__((cleanup(free_insitu))) fibrad_insitu
#define OWNED_PILE   __attribute__((cleanup(close_pile))) struct pile

static void free_block(void *pointer) {
    void *block;
    memcpy(&block, pointer, sizeof block);
    free(block);
}

static void free_insitu(fibrad_insitu **s) { fibrad_insitu_free(*s); }

/* ---- messages -------------------------------------------------------------------------------------------------- */

enum { PATTERNS = 300, BEFORE = 3 };

/* An element of twelve bytes: who sends it, and in which pattern. */
struct thing {
    int from, pattern, number;
};

/* How many things a rank sends to another: none, some or many, by chance; in every fourth pattern most send nothing. */
static int things_of(int from, int to, int pattern) {
    const uint64_t chance = hash_of(hash_of((uint64_t)from, (uint64_t)to), (uint64_t)pattern);
    if (pattern % 4 == 0 && from != pattern / 4 % ranks) return 0;
    return chance % 3 ? 0 : chance % 7 ? (int)(chance % 11) : 5000;
}

/* Messages by patterns of which the receivers know nothing, one after the other, against those of MPI_Alltoallv. */
static void things_arrive(void) {
    int *count = memory_of((size_t)ranks, 5 * sizeof *count), *got = count + ranks, *start = got + ranks;
    int *same = start + ranks, *begin = same + ranks;
    fibrad_block to = {0};
    for (int pattern = 0; pattern < PATTERNS; ++pattern) {
        int sum = 0, all = 0;
        for (int q = 0; q < ranks; ++q) count[q] = things_of(rank, q, pattern), start[q] = 3 * sum, sum += count[q];
        MPI_Alltoall(count, 1, MPI_INT, same, 1, MPI_INT, MPI_COMM_WORLD);
        for (int q = 0; q < ranks; ++q) begin[q] = 3 * all, all += same[q];
        FREED struct thing *thing = memory_of((size_t)sum, sizeof *thing),
                           *known = memory_of((size_t)all, sizeof *known);
        for (int k = 0; k < sum; ++k) thing[k] = (struct thing){rank, pattern, k};
        CHECK(fibrad_block_fit(&to, BEFORE, sizeof *thing) == FIBRAD_OK);
        memset(to.at, pattern, BEFORE * sizeof *thing);
        const int broken = pattern % 5 == 0 && rank == pattern / 5 % ranks ? FIBRAD_E_GEOMETRY : FIBRAD_OK;
        const int status = fibrad_deal(MPI_COMM_WORLD, broken, thing, count, sizeof *thing, &to, BEFORE, got);
        CHECK(status == (pattern % 5 == 0 ? FIBRAD_E_GEOMETRY : FIBRAD_OK));
        for (int q = 0; q < 2 * ranks; ++q) count[q] *= 3; /* as numbers; got is behind count */
        for (int q = 0; q < ranks; ++q) same[q] *= 3;
        MPI_Alltoallv(thing, count, start, MPI_INT, known, same, begin, MPI_INT, MPI_COMM_WORLD);
        const unsigned char *byte = to.at;
        bool kept = true;
        for (size_t k = 0; k < BEFORE * sizeof *thing; ++k) kept = kept && byte[k] == pattern % 256;
        CHECK(kept);
        if (!status) CHECK(memcmp(got, same, (size_t)ranks * sizeof *got) == 0);
        if (!status) CHECK(memcmp(byte + BEFORE * sizeof *thing, known, (size_t)all * sizeof *known) == 0);
    }
    fibrad_block_free(&to);
    free(count);
}

/* ---- link ------------------------------------------------------------------------------------------------------ */

enum { OWNED = 150, USED = 400, WIDTH = 3 };

/* Id k of a rank. Ids have all 64 bits, and 0 and the largest number are among them. Further: the k-th id that a rank
 * uses, and the value that it adds for this id. */
static uint64_t owned_id(int owner, int k) {
    if (owner == 0 && k == 0) return 0;
    return owner == 0 && k == 1 ? UINT64_MAX : hash_of((uint64_t)owner, (uint64_t)k);
}
static int owned_by(int owner) { return owner == 1 ? 0 : OWNED; }
static uint64_t used_id(int user, int k) {
    const int owner = (int)(hash_of((uint64_t)user, 7 + (uint64_t)k) % (uint64_t)ranks);
    return owned_id(owned_by(owner) ? owner : 0, (int)(hash_of((uint64_t)k, (uint64_t)user) % OWNED));
}
static double value_of(uint64_t id, int c) { return (double)(id % 1000003) * (c + 1); }
static double added_by(int user, int k, int c) { return user * 1000 + k + 7 * c; }

static void links(void) {
    const int own = owned_by(rank);
    uint64_t *id = memory_of(OWNED + USED, sizeof *id), culprit = 0;
    FREED double(*value)[WIDTH] = memory_of(OWNED + USED, sizeof *value);
    fibrad_link *link;
    for (int k = 0; k < own; ++k) id[k] = owned_id(rank, k);
    for (int k = 0; k < USED; ++k) id[own + k] = used_id(rank, k);
    const size_t all = (size_t)own + USED;
    CHECK(fibrad_link_new(&link, MPI_COMM_WORLD, id, (size_t)own, all, &culprit) == FIBRAD_OK);
    for (int again = 0; again < 2; ++again) {
        for (int k = 0; k < own; ++k)
            for (int c = 0; c < WIDTH; ++c) value[k][c] = value_of(id[k], c);
        fibrad_link_forward(link, value[0], WIDTH);
        bool same = true;
        for (size_t k = 0; k < all; ++k)
            for (int c = 0; c < WIDTH; ++c) same = same && value[k][c] == value_of(id[k], c);
        CHECK(same);
        for (int k = 0; k < USED; ++k)
            for (int c = 0; c < WIDTH; ++c) value[own + k][c] = added_by(rank, k, c);
        fibrad_link_reverse(link, value[0], WIDTH);
        for (int k = 0; k < USED; ++k) same = same && value[own + k][0] == 0 && value[own + k][WIDTH - 1] == 0;
        for (int k = 0; k < own; ++k)
            for (int c = 0; c < WIDTH; ++c) {
                double sum = value_of(id[k], c); /* sums of whole numbers are exact in any order */
                for (int user = 0; user < ranks; ++user)
                    for (int u = 0; u < USED; ++u)
                        if (used_id(user, u) == id[k]) sum += added_by(user, u, c);
                same = same && value[k][c] == sum;
            }
        CHECK(same);
    }
    fibrad_link_free(link);

    if (rank == ranks - 1) id[all - 1] = 77, id[all - 2] = 55; /* two ids that no rank owns */
    CHECK(fibrad_link_new(&link, MPI_COMM_WORLD, id, (size_t)own, all, &culprit) == FIBRAD_E_ARGUMENT && !link);
    CHECK(culprit == 55);
    if (own) id[own - 1] = id[0], culprit = 1; /* an id that each rank has twice: the least is 0, of rank 0 */
    CHECK(fibrad_link_new(&link, MPI_COMM_WORLD, id, (size_t)own, (size_t)own, &culprit) == FIBRAD_E_ARGUMENT && !link);
    CHECK(culprit == 0);
    CHECK(fibrad_link_new(&link, MPI_COMM_WORLD, NULL, 0, 0, NULL) == FIBRAD_OK);
    fibrad_link_forward(link, NULL, 1);
    fibrad_link_free(link);
    free(id);
}

/* ---- beds ------------------------------------------------------------------------------------------------------ */

#define PITCH 2.125 /* all coordinates are multiples of 2^-20, so that moving by a period is exact */

/* Particles, all or those of a rank, and the rest of the bed. */
struct pile {
    fibrad_insitu_bed bed;
    uint64_t *id;
    double *x, *radius, *emissivity, *conductivity, *temperature, *power;
    fibrad_wall *wall;
    double *wall_emissivity;
};

static void open_pile(struct pile *p, size_t n) {
    p->id = memory_of(n, sizeof *p->id);
    p->x = memory_of(3 * n, sizeof *p->x);
    p->radius = memory_of(n, sizeof *p->radius);
    p->emissivity = memory_of(n, sizeof *p->emissivity);
    p->conductivity = memory_of(n, sizeof *p->conductivity);
    p->temperature = memory_of(n, sizeof *p->temperature);
    p->power = memory_of(n, sizeof *p->power);
    p->wall = memory_of(2, sizeof *p->wall);
    p->wall_emissivity = memory_of(2, sizeof *p->wall_emissivity);
    p->bed.id = p->id, p->bed.x = p->x, p->bed.radius = p->radius, p->bed.emissivity = p->emissivity;
    p->bed.conductivity = p->conductivity;
    p->bed.wall = p->wall, p->bed.wall_emissivity = p->wall_emissivity;
}

static void close_pile(struct pile *p) {
    free(p->id);
    free(p->x);
    free(p->radius);
    free(p->emissivity);
    free(p->conductivity);
    free(p->temperature);
    free(p->power);
    free(p->wall);
    free(p->wall_emissivity);
}

enum walls { OPEN, FLOORS, TUBE, PIPE };

/* Both ends of a pipe along each axis, where the particles end. */
static const fibrad_plane ends[3][2] = {
    {{0, 0, NAN}, {0, 1, NAN}}, {{1, 0, NAN}, {1, 1, NAN}}, {{2, 0, NAN}, {2, 1, NAN}}};

/* Least k* of the particles of the next piles. The largest is 10 times as large. 0: infinite. */
static double conducting;

/* The properties of a bed of side^3 particles. */
struct kind {
    const char *name;
    int side, periodic[3];
    enum walls walls;
    double emissivity[2]; /* of every other particle */
    double cutoff;
    int threads, spread;
};

/* A lattice whose particles are moved by up to a tenth of its pitch, in a box that begins at -1. */
static struct pile pile_of(const struct kind *kind) {
    const int side = kind->side;
    const double box = PITCH * side;
    struct pile p = {.bed = {.low = {-1, -1, -1}, .high = {box - 1, box - 1, box - 1}}};
    open_pile(&p, (size_t)(side * side * side));
    memcpy(p.bed.periodic, kind->periodic, sizeof p.bed.periodic);
    for (int i = 0; i < side * side * side; ++i) {
        const int place[3] = {i % side, i / side % side, i / side / side};
        const uint64_t id = hash_of((uint64_t)i, 1);
        double x[3];
        for (int axis = 0; axis < 3; ++axis)
            x[axis] =
                round((PITCH * (place[axis] + .5 + .2 * (random_of(id, (uint64_t)axis) - .5)) - 1) * 0x1p20) / 0x1p20;
        if (kind->walls >= TUBE && hypot(x[0] - box / 2 + 1, x[1] - box / 2 + .75) > box / 2) continue;
        const size_t n = p.bed.n++;
        p.id[n] = id;
        memcpy(p.x + 3 * n, x, sizeof x);
        p.radius[n] = .75 + .25 * random_of(id, 3);
        p.emissivity[n] = kind->emissivity[i % 2];
        p.conductivity[n] = conducting > 0 ? conducting * pow(10, random_of(id, 5)) : INFINITY;
        p.temperature[n] = 600 + 800 * random_of(id, 4);
    }
    if (kind->walls == FLOORS)
        for (int k = 0; k < 2; ++k)
            p.wall[p.bed.walls++] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {2, k, k ? box - 1 : -1}};
    if (kind->walls == PIPE) p.bed.opening = ends[2], p.bed.openings = 2;
    if (kind->walls >= TUBE)
        p.wall[p.bed.walls++] =
            (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {box / 2 - 1, box / 2 - .75, box / 2, 2}};
    p.wall_emissivity[0] = kind->emissivity[0], p.wall_emissivity[1] = .5;
    return p;
}

/* Turns a point, and axes cyclically, so that z becomes this axis. */
static void turn_axes(double x[3], int axis) {
    const double from[3] = {x[0], x[1], x[2]};
    for (int k = 0; k < 3; ++k) x[(k + axis + 1) % 3] = from[k];
}

/* Turns a tube or a pipe until it lies along another axis. */
static void lay_along(struct pile *p, int axis) {
    const double x = p->wall->cylinder.x;
    const int periodic = p->bed.periodic[2];
    for (size_t i = 0; i < p->bed.n; ++i) turn_axes(p->x + 3 * i, axis);
    p->wall->cylinder.along = axis;
    p->bed.periodic[2] = 0, p->bed.periodic[axis] = periodic;
    if (p->bed.openings) p->bed.opening = ends[axis];
    if (axis == 1) p->wall->cylinder.x = p->wall->cylinder.y, p->wall->cylinder.y = x; /* x y z become z x y, y z x */
}

/* The owner of a particle: by chance, by height, the last rank owns all, all ranks but rank 0. */
enum { SPREADS = 4 };
static int owner_of(const struct pile *p, size_t i, int spread) {
    const int chance = (int)(hash_of(p->id[i], 5) % (uint64_t)ranks);
    switch (spread) {
    case 0:
        return chance;
    case 1:
        return (int)fmin(ranks - 1, fmax(0, floor((p->x[3 * i + 2] + 1) / (p->bed.high[2] + 1) * ranks)));
    case 2:
        return ranks - 1;
    default:
        return chance ? chance : ranks - 1;
    }
}

/* A pile without particles. It has the walls of another pile and room for its particles. */
static struct pile emptied(const struct pile *all) {
    struct pile p = *all;
    open_pile(&p, all->bed.n);
    memcpy(p.wall, all->wall, 2 * sizeof *p.wall);
    memcpy(p.wall_emissivity, all->wall_emissivity, 2 * sizeof *p.wall_emissivity);
    p.bed.n = 0;
    return p;
}

static void take_particle(struct pile *p, const struct pile *from, size_t i) {
    const size_t n = p->bed.n++;
    p->id[n] = from->id[i], p->radius[n] = from->radius[i];
    memcpy(p->x + 3 * n, from->x + 3 * i, 3 * sizeof *p->x);
    p->emissivity[n] = from->emissivity[i], p->conductivity[n] = from->conductivity[i];
    p->temperature[n] = from->temperature[i];
}

/* The part of a pile that this rank owns, in another order. Some particles are moved by periods. */
static struct pile part_of(const struct pile *all, int spread) {
    struct pile p = emptied(all);
    for (size_t k = all->bed.n; k-- > 0;) {
        const size_t i = all->bed.n % 7 ? 7 * k % all->bed.n : k; /* all once */
        if (owner_of(all, i, spread) != rank) continue;
        take_particle(&p, all, i);
        double *x = p.x + 3 * (p.bed.n - 1);
        for (int axis = 0; axis < 3; ++axis)
            x[axis] += p.bed.periodic[axis] ? ((int)(all->id[i] % 5) - 2) * (p.bed.high[0] + 1) : 0;
    }
    return p;
}

/* ---- files ----------------------------------------------------------------------------------------------------- */

/* A file of rows. */
struct rows_file {
    fibrad_rows_head head;
    uint64_t *word, *id, *start, *col;
    double *f, *wall, *escaped, *beyond, *error, *radius, *emissivity, *x;
};

static const char *path_of(const char *name) {
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static struct rows_file read_rows(const char *name, int of) {
    struct rows_file r = {0};
    char path[4200];
    snprintf(path, sizeof path, "%s.%d.rows", path_of(name), of);
    FILE *file = fopen(path, "rb");
    CHECK(file);
    if (!file) return r;
    CHECK(fread(&r.head, sizeof r.head, 1, file) == 1 && memcmp(r.head.magic, FIBRAD_ROWS_MAGIC, 8) == 0);
    const size_t n = r.head.rows, entries = r.head.entries, words = 2 * n + 1 + 2 * entries + n * (8 + r.head.walls);
    r.word = memory_of(words + 1, sizeof *r.word);
    CHECK(fread(r.word, sizeof *r.word, words + 1, file) == words);
    fclose(file);
    remove(path);
    r.id = r.word, r.start = r.id + n, r.col = r.start + n + 1;
    r.f = (double *)(r.col + entries), r.wall = r.f + entries, r.escaped = r.wall + n * r.head.walls;
    r.beyond = r.escaped + n, r.error = r.beyond + n, r.radius = r.error + n, r.emissivity = r.radius + n;
    r.x = r.emissivity + n;
    return r;
}

static bool equal_words(const void *a, const void *b, size_t words) { return memcmp(a, b, words * 8) == 0; }

/* Whether row i of one file is row k of another, to the bit. The row must be closed, or empty at emissivity 0, and its
 * columns must ascend. */
static bool same_row(const struct rows_file *a, size_t i, const struct rows_file *b, size_t k) {
    const uint64_t length = a->start[i + 1] - a->start[i], walls = a->head.walls;
    if (length != b->start[k + 1] - b->start[k]) return false;
    const uint64_t *col = a->col + a->start[i];
    const double *f = a->f + a->start[i];
    double sum = a->escaped[i] + a->beyond[i];
    for (uint64_t m = 0; m < length; ++m) {
        if (m && col[m] <= col[m - 1]) return false;
        sum += f[m];
    }
    for (uint64_t m = 0; m < walls; ++m) sum += a->wall[i * walls + m];
    return fabs(sum - (a->emissivity[i] > 0)) < 1e-12 && equal_words(col, b->col + b->start[k], length) &&
           equal_words(f, b->f + b->start[k], length) && equal_words(a->wall + i * walls, b->wall + k * walls, walls) &&
           equal_words(&a->escaped[i], &b->escaped[k], 1) && equal_words(&a->beyond[i], &b->beyond[k], 1) &&
           equal_words(&a->error[i], &b->error[k], 1) && equal_words(&a->radius[i], &b->radius[k], 1) &&
           equal_words(&a->emissivity[i], &b->emissivity[k], 1) && equal_words(a->x + 3 * i, b->x + 3 * k, 3);
}

static size_t place_of(const struct rows_file *r, uint64_t id) {
    size_t k = 0;
    while (k < r->head.rows && r->id[k] != id) ++k;
    return k;
}

/* Compares the rows of all ranks in the files `part` with those of the one file `whole`. */
static void compare_files(const char *part, const char *whole) {
    if (rank) return;
    struct rows_file b = read_rows(whole, 0);
    uint64_t rows = 0, same = 0;
    for (int q = 0; q < ranks; ++q) {
        struct rows_file a = read_rows(part, q);
        CHECK(a.head.rank == (uint64_t)q && a.head.ranks == (uint64_t)ranks && a.head.step == b.head.step);
        CHECK(a.head.walls == b.head.walls && a.head.emissive == b.head.emissive && a.head.cutoff == b.head.cutoff);
        for (size_t i = 0; i < a.head.rows; ++i, ++rows) {
            const size_t k = place_of(&b, a.id[i]);
            same += k < b.head.rows && (i == 0 || a.id[i] > a.id[i - 1]) && same_row(&a, i, &b, k);
        }
        free(a.word);
    }
    CHECK(rows == b.head.rows);
    CHECK(same == rows);
    if (same != rows) fprintf(stderr, "%llu of %llu rows\n", (unsigned long long)same, (unsigned long long)rows);
    free(b.word);
}

/* ---- rows ------------------------------------------------------------------------------------------------------ */

static const struct kind kinds[] = {
    {"defaults", 5, {0, 0, 0}, OPEN, {.8, .8}, 0, 1, 0}, {"near", 5, {0, 0, 0}, OPEN, {.3, .8}, 4, 2, 1},
    {"black", 5, {0, 0, 0}, FLOORS, {1, 1}, 5, 1, 3},    {"floors", 4, {1, 1, 0}, FLOORS, {.3, .8}, 5, 1, 1},
    {"small", 3, {1, 1, 1}, OPEN, {1, .8}, 8, 2, 0},     {"tube", 5, {0, 0, 1}, TUBE, {.8, 1}, 0, 1, 2},
    {"far", 4, {0, 0, 0}, OPEN, {.3, .8}, 1000, 1, 0},   {"mirrors", 5, {0, 0, 0}, FLOORS, {0, .8}, 6, 2, 1},
    {"pipe", 5, {0, 0, 0}, PIPE, {.8, .5}, 6, 1, 1},     {"whole", 4, {1, 1, 0}, FLOORS, {.3, .8}, 0, 2, 1},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static int strict;    /* of the next objects */
static double gather; /* the same; 0: the default */

static fibrad_insitu *insitu_of(MPI_Comm comm, const struct kind *kind, int threads) {
    const fibrad_insitu_config config = {
        .cutoff = kind->cutoff, .directions = 50, .paths = 100, .seed = 3, .threads = threads, .strict = strict};
    fibrad_insitu *s;
    CHECK(fibrad_insitu_new(&s, comm, &config) == FIBRAD_OK);
    if (gather > 0) s->gather = gather;
    return s;
}

static void make_rows(fibrad_insitu *s, const struct pile *p, uint64_t step) {
    const int status = fibrad_insitu_rows(s, &p->bed, step);
    CHECK(status == FIBRAD_OK);
    if (status) fprintf(stderr, "%s\n", fibrad_insitu_message(s));
}

/* The rows of all ranks, whichever rank owns which particles, are those of one rank that owns all. A tube or a pipe
 * lies along an axis. */
static void rows_are_those_of_one_rank(const struct kind *kind, int axis) {
    OWNED_PILE all = pile_of(kind);
    lay_along(&all, axis);
    if (rank == 0) {
        OWNED_INSITU *self = insitu_of(MPI_COMM_SELF, kind, 1);
        make_rows(self, &all, 7);
        CHECK(fibrad_insitu_write(self, path_of("whole")) == FIBRAD_OK);
    }
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, kind, kind->threads);
    for (int again = 0; again < 2; ++again) { /* first other rows, so that the memory is not empty */
        OWNED_PILE part = part_of(&all, again ? kind->spread : (kind->spread + 1) % SPREADS);
        make_rows(s, &part, again ? 7 : 6);
    }
    CHECK(fibrad_insitu_write(s, path_of("part")) == FIBRAD_OK);
    MPI_Barrier(MPI_COMM_WORLD);
    compare_files("part", "whole");
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(s, &facts);
    CHECK(facts.particles == all.bed.n && facts.step == 7 && facts.entries > 0 && facts.bytes > 0);
    CHECK(facts.error > 0 && facts.error < .1 && facts.beyond >= 0 && facts.beyond < .3);
    CHECK((facts.cutoff > 0) == (kind->cutoff > 0 ? kind->cutoff < 1000 : gather > 0));
}

/* ---- powers ---------------------------------------------------------------------------------------------------- */

static const double wall_temperature[2] = {1500, 400};

static fibrad_insitu_state state_of(const struct pile *p) {
    return (fibrad_insitu_state){.surroundings = 500,
                                 .wall_temperature = wall_temperature,
                                 .n = p->bed.n,
                                 .id = p->id,
                                 .temperature = p->temperature};
}

/* Powers add up to zero. Between equal temperatures nothing flows, to the bit. */
static void powers_keep_energy(const struct kind *kind) {
    OWNED_PILE all = pile_of(kind), part = part_of(&all, kind->spread);
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, kind, 1);
    fibrad_insitu_totals totals;
    make_rows(s, &part, 0);
    fibrad_insitu_state state = state_of(&part);
    CHECK(fibrad_insitu_powers(s, &state, part.power, &totals) == FIBRAD_OK);
    double sum = 0, emitted = 0, largest = 0, here = 0;
    for (size_t i = 0; i < part.bed.n; ++i) here += part.power[i], largest = fmax(largest, fabs(part.power[i]));
    for (size_t i = 0; i < part.bed.n; ++i) CHECK(part.emissivity[i] > 0 || part.power[i] == 0);
    for (size_t i = 0; i < all.bed.n; ++i)
        emitted += 4 * acos(-1) * all.radius[i] * all.radius[i] * all.emissivity[i] * FIBRAD_STEFAN_BOLTZMANN *
                   pow(all.temperature[i], 4);
    MPI_Allreduce(&here, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    double left = totals.particles + totals.surroundings;
    for (uint32_t k = 0; k < all.bed.walls; ++k) left += totals.wall[k];
    CHECK(fabs(left) < 1e-14 * emitted);
    CHECK(fabs(sum - totals.particles) < 1e-14 * emitted);
    CHECK(largest > 0 || part.bed.n == 0);

    const double same[2] = {777, 777};
    for (size_t i = 0; i < part.bed.n; ++i) part.temperature[i] = 777;
    state.surroundings = 777, state.wall_temperature = same;
    CHECK(fibrad_insitu_powers(s, &state, part.power, &totals) == FIBRAD_OK);
    bool zero = totals.particles == 0 && totals.surroundings == 0 && totals.wall[0] == 0 && totals.wall[1] == 0;
    for (size_t i = 0; i < part.bed.n; ++i) zero = zero && part.power[i] == 0;
    CHECK(zero);
}

/* Rows that are made again, when particles have changed ranks, give the powers of a new object, to the bit. */
static void powers_of_rows_made_again(const struct kind *kind) {
    OWNED_PILE all = pile_of(kind), before = part_of(&all, (kind->spread + 1) % SPREADS);
    OWNED_PILE part = part_of(&all, kind->spread);
    FREED double *power = memory_of(all.bed.n, sizeof *power);
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, kind, 1), *fresh = insitu_of(MPI_COMM_WORLD, kind, 1);
    fibrad_insitu_totals totals[2];
    make_rows(s, &before, 0);
    make_rows(s, &part, 1);
    make_rows(fresh, &part, 1);
    const fibrad_insitu_state state = state_of(&part);
    CHECK(fibrad_insitu_powers(s, &state, part.power, &totals[0]) == FIBRAD_OK);
    CHECK(fibrad_insitu_powers(fresh, &state, power, &totals[1]) == FIBRAD_OK);
    CHECK(memcmp(part.power, power, part.bed.n * sizeof *power) == 0 &&
          memcmp(&totals[0], &totals[1], sizeof *totals) == 0);
}

/* A lone particle loses A e (E - E of the surroundings), however little it conducts. */
static void a_lone_particle(void) {
    static const double relative[] = {.001, .1, 10};
    for (int k = 0; k < 3; ++k) {
        const uint64_t id = 5;
        const double x[3] = {0}, r = 2, e = .7, t = 900, loss = 4 * acos(-1) * r * r * e * FIBRAD_STEFAN_BOLTZMANN;
        const fibrad_insitu_bed bed = {
            .n = rank == 0, .id = &id, .x = x, .radius = &r, .emissivity = &e, .conductivity = &relative[k]};
        const fibrad_insitu_state state = {.surroundings = 400, .n = bed.n, .id = &id, .temperature = &t};
        OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, &(struct kind){0}, 1);
        fibrad_insitu_totals totals;
        double power;
        CHECK(fibrad_insitu_rows(s, &bed, 0) == FIBRAD_OK);
        CHECK(fibrad_insitu_powers(s, &state, &power, &totals) == FIBRAD_OK);
        CHECK(fabs(totals.particles / (loss * (pow(400, 4) - pow(t, 4))) - 1) < 1e-9);
    }
}

#define SPECK_TOLERANCE 2e-3
#define SPECK_PATHS     200000 /* of a particle; sources have some times more */

/* A speck in a box of side 1 hides next to nothing of the walls from each other. */
static fibrad_insitu_totals powers_beside_a_speck(const fibrad_insitu_bed *walls, const double *temperature, bool speck,
                                                  fibrad_insitu_facts *facts) {
    const uint64_t id = 7;
    const double x[3] = {.5, .5, .5}, r = 1e-4, e = .5, t = 300;
    fibrad_insitu_bed bed = *walls;
    bed.n = speck && rank == 0, bed.id = &id, bed.x = x, bed.radius = &r, bed.emissivity = &e;
    const fibrad_insitu_state state = {
        .sigma = 1, .surroundings = 0, .wall_temperature = temperature, .n = bed.n, .id = &id, .temperature = &t};
    const fibrad_insitu_config config = {.paths = SPECK_PATHS};
    OWNED_INSITU *s;
    fibrad_insitu_totals totals;
    double power;
    CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, &config) == FIBRAD_OK);
    CHECK(fibrad_insitu_rows(s, &bed, 0) == FIBRAD_OK);
    CHECK(fibrad_insitu_powers(s, &state, &power, &totals) == FIBRAD_OK);
    fibrad_insitu_facts_get(s, facts);
    return totals;
}

/* Two plates of emissivities e and d exchange A/(1/e + 1/d - 1). A black face of a cube and the opposite one exchange
 * 0.19982 A (Siegel, Howell, configuration C-11), the surroundings behind an opening as well. */
static void walls_exchange_with_each_other(void) {
    static const fibrad_wall face[6] = {
        {.kind = FIBRAD_WALL_PLANE, .plane = {2, 0, 0}}, {.kind = FIBRAD_WALL_PLANE, .plane = {2, 1, 1}},
        {.kind = FIBRAD_WALL_PLANE, .plane = {0, 0, 0}}, {.kind = FIBRAD_WALL_PLANE, .plane = {0, 1, 1}},
        {.kind = FIBRAD_WALL_PLANE, .plane = {1, 0, 0}}, {.kind = FIBRAD_WALL_PLANE, .plane = {1, 1, 1}}};
    static const double grey[] = {.6, .3}, black[] = {1, 1, 1, 1, 1, 1}, hot[] = {10, 20, 0, 0, 0, 0};
    const double between = 1 / (1 / grey[0] + 1 / grey[1] - 1), opposite = .19982, beside = (1 - opposite) / 4;
    fibrad_insitu_facts facts;

    const fibrad_insitu_bed plates = {
        .high = {1, 1, 1}, .periodic = {1, 1, 0}, .wall = face, .wall_emissivity = grey, .walls = 2};
    const fibrad_insitu_bed cube = {.wall = face, .wall_emissivity = black, .walls = 6};
    const fibrad_insitu_bed open = {
        .wall = face + 1, .wall_emissivity = black, .walls = 5, .opening = &face[0].plane, .openings = 1};
    for (int speck = 0; speck < 2; ++speck) { /* without particles walls exchange, too */
        fibrad_insitu_totals totals = powers_beside_a_speck(&plates, hot, speck, &facts);
        const double tolerance = (speck ? 3 : 6) * SPECK_TOLERANCE;
        CHECK(fabs(totals.wall[0] / 150000 - between) < tolerance);
        CHECK(fabs(totals.wall[0] + totals.wall[1] + totals.particles) < 1e-9);
        CHECK(fabs(facts.wall[0] - between) < tolerance && fabs(facts.wall[1] / facts.wall[0] - 1) < 1e-6);
        totals = powers_beside_a_speck(&cube, hot, speck, &facts);
        CHECK(fabs(totals.wall[0] / 150000 - (opposite - 4 * beside / 15)) < tolerance);
        for (int k = 2; k < 6; ++k) CHECK(fabs(totals.wall[k] / 170000 - beside) < tolerance);
        totals = powers_beside_a_speck(&open, hot + 1, speck, &facts);
        CHECK(fabs(totals.surroundings / 160000 - opposite) < tolerance);
    }
}

/* Rows of another step have other noise. Rows of the same step are the same. */
static void steps_change_noise(void) {
    const struct kind *kind = &kinds[1];
    OWNED_PILE all = pile_of(kind), part = part_of(&all, 0);
    const size_t n = part.bed.n;
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, kind, 1);
    const fibrad_insitu_state state = state_of(&part);
    FREED double *power = memory_of(3 * n, sizeof *power);
    for (uint64_t k = 0; k < 3; ++k) {
        make_rows(s, &part, 4 + k % 2);
        CHECK(fibrad_insitu_powers(s, &state, power + k * n, NULL) == FIBRAD_OK);
    }
    CHECK(memcmp(power, power + 2 * n, n * sizeof *power) == 0);
    size_t same = 0;
    for (size_t i = 0; i < n; ++i) same += power[i] == power[n + i];
    CHECK(same < n / 10 + 1);
}

/* All points of all particles lie in marked cells, and not all cells are marked. */
static void the_map_has_all(const struct kind *kind) {
    OWNED_PILE all = pile_of(kind), part = part_of(&all, kind->spread);
    FREED fibrad_particle *own = memory_of(part.bed.n, sizeof *own);
    fibrad_occupancy map = {.mark = NULL};
    fibrad_block mark = {0};
    for (size_t i = 0; i < part.bed.n; ++i) {
        memcpy(own[i].x, part.x + 3 * i, sizeof own[i].x);
        own[i].radius = part.radius[i];
    }
    for (int axis = 0; axis < 3; ++axis) {
        map.periodic[axis] = kind->periodic[axis];
        map.low[axis] = all.bed.low[axis] - (kind->periodic[axis] ? 0 : 5);
        map.high[axis] = all.bed.high[axis] + (kind->periodic[axis] ? 0 : 5);
    }
    CHECK(fibrad_coarse_map(MPI_COMM_WORLD, .4, .5, own, part.bed.n, &mark, &map) == FIBRAD_OK);
    size_t marked = 0, cells = (size_t)map.cells[0] * map.cells[1] * map.cells[2];
    for (size_t c = 0; c < cells; ++c) marked += map.mark[c / 64] >> c % 64 & 1;
    bool there = true;
    for (size_t i = 0; i < all.bed.n; ++i)
        for (uint64_t k = 0; k < 60; ++k) {
            const double z = 2 * random_of(all.id[i], 20 + k) - 1, turn = 7 * random_of(all.id[i], 90 + k);
            const double d[3] = {sqrt(1 - z * z) * cos(turn), sqrt(1 - z * z) * sin(turn), z};
            size_t cell[3];
            for (int axis = 0; axis < 3; ++axis) {
                const double extent = map.high[axis] - map.low[axis];
                const double x = all.x[3 * i + (size_t)axis] + all.radius[i] * d[axis] - map.low[axis];
                cell[axis] = (size_t)((x - extent * floor(x / extent)) / extent * map.cells[axis]) % map.cells[axis];
            }
            const size_t c = cell[0] + map.cells[0] * (cell[1] + map.cells[1] * cell[2]);
            there = there && map.mark[c / 64] >> c % 64 & 1;
        }
    CHECK(there);
    CHECK(100 * marked < 97 * cells);
    fibrad_block_free(&mark);
}

/* A particle far above the bed hides only a little of the sky of the others. So does a particle so far away that its
 * box would make the cells too wide. */
static void the_sky_stays_open(void) {
    const struct kind kinds_of_sky[] = {{"sky", 5, {1, 1, 0}, OPEN, {.8, .8}, 5, 1, 0},
                                        {"lost", 5, {0, 0, 0}, OPEN, {.8, .8}, 5, 1, 0}};
    const double away[2][3] = {{0, 0, 100}, {1e5, 1e5, 1e5}};
    for (int k = 0; k < 2; ++k) {
        const struct kind *kind = &kinds_of_sky[k];
        OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, kind, 1);
        fibrad_insitu_facts facts[2];
        for (int high = 0; high < 2; ++high) {
            OWNED_PILE all = pile_of(kind);
            for (int axis = 0; high && axis < 3; ++axis) all.x[3 * (all.bed.n - 1) + (size_t)axis] += away[k][axis];
            OWNED_PILE part = part_of(&all, 0);
            make_rows(s, &part, 0);
            fibrad_insitu_facts_get(s, &facts[high]);
        }
        CHECK(facts[0].beyond > 0 && facts[1].beyond < 1.1 * facts[0].beyond);
    }
}

/* Powers with a cutoff and without one: what is said of the first bounds the difference. Nothing is said if nothing
 * could change, at equal temperatures or without a cutoff. */
static void unknown_parts_are_told(enum walls walls) {
    const struct kind kind = {"unknown", 5, {walls == FLOORS, walls == FLOORS, 0}, walls, {.8, .8}, 4, 1, 0};
    struct kind whole = kind;
    whole.cutoff = 0;
    OWNED_PILE all = pile_of(&kind), part = part_of(&all, 0);
    OWNED_INSITU *near = insitu_of(MPI_COMM_WORLD, &kind, 1), *far = insitu_of(MPI_COMM_WORLD, &whole, 1);
    const double even[2] = {500, 500};
    double *power = memory_of(part.bed.n, sizeof *power), sum[3] = {0}, most = 0, said[2] = {0};
    fibrad_insitu_state state = state_of(&part);
    fibrad_insitu_facts facts;
    make_rows(near, &part, 0);
    make_rows(far, &part, 0);
    CHECK(!*fibrad_insitu_remark(near, FIBRAD_REMARK_BEYOND));
    CHECK(fibrad_insitu_powers(near, &state, part.power, NULL) == FIBRAD_OK);
    CHECK(fibrad_insitu_powers(far, &state, power, NULL) == FIBRAD_OK);
    for (size_t i = 0; i < part.bed.n; ++i) sum[0]++, sum[1] += part.power[i] * part.power[i];
    MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    const double unit = sqrt(sum[1] / sum[0]);
    for (size_t i = 0; i < part.bed.n; ++i) {
        const double change = fabs(part.power[i] - power[i]) / unit;
        most = fmax(most, 100 * change), sum[2] += change > .01;
    }
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, sum + 2, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    CHECK(
        sscanf(
            fibrad_insitu_remark(near, FIBRAD_REMARK_BEYOND),
            "what lies beyond the cutoff 4 could change the power of %lf particles by more than 1 %% of the root mean "
            "square of all powers, that of particle %*u at (%*f, %*f, %*f) by %lf %%",
            &said[0], &said[1]) == 2);
    CHECK(most > 1 && most < said[1] && said[1] < 20 * most && sum[2] > 0 && sum[2] <= said[0]);
    CHECK(!*fibrad_insitu_remark(far, FIBRAD_REMARK_BEYOND));
    for (size_t i = 0; i < part.bed.n; ++i) part.temperature[i] = 500;
    state.wall_temperature = even;
    CHECK(fibrad_insitu_powers(near, &state, part.power, NULL) == FIBRAD_OK);
    fibrad_insitu_facts_get(near, &facts);
    CHECK(facts.beyond > 1e-3 && !*fibrad_insitu_remark(near, FIBRAD_REMARK_BEYOND));
    free(power);
}

/* A particle larger than all others together sees them, and they see it. A cutoff less than its diameter is refused. */
static void large_particles_are_seen(void) {
    const struct kind kind = {"large", 4, {0, 0, 0}, OPEN, {.8, .8}, 0, 1, 0};
    OWNED_PILE all = pile_of(&kind);
    const size_t last = all.bed.n - 1;
    const double large = 15;
    all.radius[last] = large;
    all.x[3 * last + 2] += 1.5 * large;
    OWNED_PILE part = part_of(&all, 0);
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, &kind, 1);
    fibrad_insitu_facts facts;
    make_rows(s, &part, 0);
    fibrad_insitu_facts_get(s, &facts);
    CHECK(facts.cutoff == 0 && facts.beyond == 0);
    fibrad_insitu_free(s);
    const fibrad_insitu_config config = {.cutoff = 1.9 * large};
    CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, &config) == FIBRAD_OK);
    CHECK(fibrad_insitu_rows(s, &part.bed, 0) == FIBRAD_E_ARGUMENT && strstr(fibrad_insitu_message(s), "the cutoff"));
}

/* ---- a serial reference ---------------------------------------------------------------------------------------- */

enum { STEPS = 50 };
static const double heat_capacity = 3e4; /* over the time step: temperatures change by some hundred K */

static void *grow(void *context, void *block, size_t size) {
    (void)context;
    return realloc(block, size);
}

/* Temperatures after all steps by rows of the kernel in one scene, with sums written as in the formula. */
static void step_by_kernel(struct pile *p) {
    const uint32_t n = (uint32_t)p->bed.n, walls = p->bed.walls;
    const fibrad_scene_config config = {.wall = p->wall, .walls = walls};
    const fibrad_spheres spheres = {p->x, p->x + 1, p->x + 2, p->radius, n, 3, 1, p->id, NULL};
    const size_t size = fibrad_scene_size(n, 1);
    FREED void *block = memory_of(size, 1);
    fibrad_scene *scene = NULL;
    fibrad_work work = {.memory.resize = grow};
    CHECK(fibrad_scene_init(&scene, block, size, &config, &spheres, NULL) == FIBRAD_OK);
    fibrad_exchange_rule rule = {
        .emissivity = p->emissivity, .wall_emissivity = p->wall_emissivity, .directions = 50, .paths = 100};
    FREED uint32_t *col = memory_of((size_t)n * n, sizeof *col);
    FREED double *f = memory_of((size_t)n * n, sizeof *f), *emission = memory_of(n, sizeof *emission);
    FREED fibrad_row *row = memory_of(n, sizeof *row);
    FREED double(*wall)[2] = memory_of(n, sizeof *wall);
    for (uint32_t i = 0; i < n; ++i) {
        row[i] = (fibrad_row){.col = col + (size_t)i * n, .f = f + (size_t)i * n, .wall = wall[i], .capacity = n};
        rule.seed = 3 + p->id[i] * 0xd1342543de82ef95u;
        CHECK(fibrad_exchange_row(scene, &work, i, &rule, &row[i], NULL) == FIBRAD_OK);
    }
    for (int step = 0; step < STEPS; ++step) {
        for (uint32_t i = 0; i < n; ++i) emission[i] = FIBRAD_STEFAN_BOLTZMANN * pow(p->temperature[i], 4);
        memset(p->power, 0, n * sizeof *p->power);
        for (uint32_t i = 0; i < n; ++i) {
            const double weight = 4 * acos(-1) * p->radius[i] * p->radius[i] * p->emissivity[i];
            for (uint32_t k = 0; k < row[i].length; ++k) {
                const double half = weight * row[i].f[k] * (emission[row[i].col[k]] - emission[i]) / 2;
                p->power[i] += half, p->power[row[i].col[k]] -= half;
            }
            for (uint32_t b = 0; b < walls; ++b)
                p->power[i] +=
                    weight * wall[i][b] * (FIBRAD_STEFAN_BOLTZMANN * pow(wall_temperature[b], 4) - emission[i]);
            p->power[i] += weight * row[i].escaped * (FIBRAD_STEFAN_BOLTZMANN * pow(500, 4) - emission[i]);
        }
        for (uint32_t i = 0; i < n; ++i) p->temperature[i] += p->power[i] / heat_capacity;
    }
    free(work.memory.block);
}

/* Particles change ranks and positions at every third step. The rows stay where they were made. A cutoff that all
 * particles are within is none. */
static void temperatures_are_those_of_the_kernel(enum walls walls) {
    const struct kind kind = {"reference", 6, {0, 0, 0}, walls, {.3, .8}, 1000, 1, 0};
    OWNED_PILE all = pile_of(&kind), expected = pile_of(&kind);
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, &kind, 1);
    OWNED_PILE part = part_of(&all, 0);
    make_rows(s, &part, 0);
    for (int step = 0; step < STEPS; ++step) {
        const fibrad_insitu_state state = state_of(&part);
        CHECK(fibrad_insitu_powers(s, &state, part.power, NULL) == FIBRAD_OK);
        double *now = memory_of(all.bed.n, sizeof *now);
        for (size_t i = 0; i < part.bed.n; ++i)
            for (size_t k = 0; k < all.bed.n; ++k)
                if (all.id[k] == part.id[i]) now[k] = part.temperature[i] + part.power[i] / heat_capacity;
        MPI_Allreduce(now, all.temperature, (int)all.bed.n, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
        free(now);
        close_pile(&part);
        part = part_of(&all, step / 3 % SPREADS);
    }
    if (rank == 0) {
        double worst = 0, change = 0;
        step_by_kernel(&expected);
        struct pile begin = pile_of(&kind);
        for (size_t i = 0; i < all.bed.n; ++i) {
            worst = fmax(worst, fabs(all.temperature[i] - expected.temperature[i]));
            change = fmax(change, fabs(all.temperature[i] - begin.temperature[i]));
        }
        close_pile(&begin);
        CHECK(worst < 1e-10);
        CHECK(change > 100 && change < 2000);
    }
}

/* ---- strays ----------------------------------------------------------------------------------------------------- */

enum { FLOWN = 5, SUNK = 11, DEEP = 20, SWALLOWED = 30 };

/* The distance of a particle from the next one, so that the centre of the smaller one lies inside the larger one. The
 * centre of the larger one lies outside the smaller one. */
static double deep(const struct pile *p) { return (p->radius[DEEP] + p->radius[DEEP + 1]) / 2; }

/* Puts one particle above the ceiling, one below the floor, one inside another, and two at the same point. */
static void go_astray(struct pile *p) {
    p->x[3 * FLOWN + 2] = 1e3;
    p->x[3 * SUNK + 2] = -1.25;
    memcpy(p->x + 3 * DEEP, p->x + 3 * DEEP + 3, 3 * sizeof *p->x), p->x[3 * DEEP + 1] += deep(p);
    memcpy(p->x + 3 * SWALLOWED, p->x + 3 * SWALLOWED + 3, 3 * sizeof *p->x);
}

/* The same bed without the particles that are left out. The others have the radii that they have in the rows. */
static struct pile without_strays(const struct pile *astray) {
    struct pile p = emptied(astray);
    const double largest = fmax(astray->radius[DEEP], astray->radius[DEEP + 1]);
    for (size_t i = 0; i < astray->bed.n; ++i) {
        if (i == FLOWN || i == SUNK || i == SWALLOWED || i == SWALLOWED + 1) continue;
        take_particle(&p, astray, i);
        if (i == DEEP || i == DEEP + 1) p.radius[p.bed.n - 1] *= deep(astray) / largest * (1 - 1e-9);
    }
    return p;
}

/* Rows go on with strays. Powers are those of the bed without the strays, and strays have none. */
static void strays_do_not_end_a_run(void) {
    static const struct kind kind = {"strays", 4, {1, 1, 0}, FLOORS, {.8, .5}, 4, 1, 0};
    OWNED_PILE all = pile_of(&kind);
    go_astray(&all);
    OWNED_PILE rest = without_strays(&all), part = part_of(&all, 0), known = part_of(&rest, 0);
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, &kind, 1), *t = insitu_of(MPI_COMM_WORLD, &kind, 1);
    fibrad_insitu_totals totals[2];
    make_rows(s, &part, 2);
    make_rows(t, &known, 2);
    const fibrad_insitu_state state[2] = {state_of(&part), state_of(&known)};
    CHECK(fibrad_insitu_powers(s, &state[0], part.power, &totals[0]) == FIBRAD_OK);
    CHECK(fibrad_insitu_powers(t, &state[1], known.power, &totals[1]) == FIBRAD_OK);
    double most = 0, sum = 0;
    for (size_t i = 0; i < part.bed.n; ++i) {
        size_t k = 0;
        while (k < known.bed.n && known.id[k] != part.id[i]) ++k;
        const double power = k < known.bed.n ? known.power[k] : 0;
        CHECK(fabs(part.power[i] - power) <= 1e-7 * fabs(power)); /* the reduced radii are rounded in another way */
        most = fmax(most, fabs(power)), sum += part.power[i];
    }
    CHECK(most > 0 || part.bed.n == 0);
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    CHECK(fabs(sum - totals[0].particles) < 1e-12 * fabs(sum));
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(s, &facts);
    CHECK(facts.outside == 4 && facts.overlapping == 4 && facts.behind == 0 && facts.particles == rest.bed.n);
    CHECK(strstr(fibrad_insitu_remark(s, FIBRAD_REMARK_OUTSIDE), "4 particles are left out"));
    CHECK(strstr(fibrad_insitu_remark(s, FIBRAD_REMARK_OVERLAP), "the centre of one lies inside the other"));
    CHECK(strcmp(fibrad_insitu_remark(s, FIBRAD_REMARK_BACK), "") == 0);
    CHECK(strcmp(fibrad_insitu_remark(t, FIBRAD_REMARK_OUTSIDE), "") == 0);
    for (size_t i = 0; i < part.bed.n; ++i) /* another particle in the place of one that is left out, so rows are new */
        if (part.id[i] == all.id[FLOWN]) part.id[i] = 12345;
    CHECK(fibrad_insitu_powers(s, &state[0], part.power, NULL) == FIBRAD_E_STATE);
}

/* ---- particles that come and go --------------------------------------------------------------------------------- */

/* A part without the particles whose number in the whole bed is a multiple of `of`. */
static struct pile without(const struct pile *all, size_t of) {
    struct pile p = emptied(all);
    for (size_t i = 0; i < all->bed.n; ++i)
        if (i % of != 0) take_particle(&p, all, i);
    return p;
}

/* Powers of all particles of the whole bed by number, summed over ranks. Particles that are not in the part have 0. */
static double *gather_powers(const struct pile *all, const struct pile *part) {
    double *power = memory_of(all->bed.n, sizeof *power);
    for (size_t i = 0; i < all->bed.n; ++i) {
        power[i] = 0;
        for (size_t k = 0; k < part->bed.n; ++k)
            if (part->id[k] == all->id[i]) power[i] = part->power[k];
    }
    MPI_Allreduce(MPI_IN_PLACE, power, (int)all->bed.n, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return power;
}

/* Follows a bed from `before` to `after`, in which particles have other owners. Powers keep energy, are the same as on
 * one rank, and are near those of new rows. */
static void follow_changes(const struct kind *kind, const struct pile *all, const struct pile *before,
                           const struct pile *after, double bound) {
    OWNED_PILE old = part_of(before, 0), now = part_of(after, 1);
    OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, kind, 2), *t = insitu_of(MPI_COMM_WORLD, kind, 1);
    fibrad_insitu_totals totals, exact;
    make_rows(s, &old, 4);
    make_rows(t, &now, 4);
    const fibrad_insitu_state state = state_of(&now);
    CHECK(fibrad_insitu_follow(s, &now.bed, 4) == FIBRAD_OK);
    CHECK(fibrad_insitu_powers(t, &state, now.power, &exact) == FIBRAD_OK);
    FREED double *expected = gather_powers(all, &now);
    CHECK(fibrad_insitu_powers(s, &state, now.power, &totals) == FIBRAD_OK);
    double *found = gather_powers(all, &now), error = 0, norm = 0, emitted = 0, alone[2] = {0};
    for (size_t i = 0; i < all->bed.n; ++i)
        error += pow(found[i] - expected[i], 2), norm += pow(expected[i], 2), emitted += fabs(found[i]);
    CHECK(error < bound * bound * norm);
    CHECK(fabs(totals.particles + totals.surroundings + totals.wall[0] + totals.wall[1]) < 1e-13 * emitted);
    if (rank == 0) { /* the same by one rank */
        OWNED_INSITU *u = insitu_of(MPI_COMM_SELF, kind, 1);
        const fibrad_insitu_state whole = state_of(after);
        make_rows(u, before, 4);
        CHECK(fibrad_insitu_follow(u, &after->bed, 4) == FIBRAD_OK);
        CHECK(fibrad_insitu_powers(u, &whole, after->power, &totals) == FIBRAD_OK);
        for (size_t k = 0; k < after->bed.n; ++k)
            for (size_t i = 0; i < all->bed.n; ++i)
                if (after->id[k] == all->id[i]) alone[0] = fmax(alone[0], fabs(after->power[k] - found[i]));
        CHECK(alone[0] < 1e-12 * sqrt(norm));
    }
    CHECK(fibrad_insitu_write(s, path_of("followed")) == FIBRAD_E_STATE);
    free(found);
}

/* Twelve pairs of spheres, far apart. When one of a pair has gone, the other one gives all to the surroundings. */
static void what_goes_is_given_back(void) {
    enum { MOST = 24 };
    double x[MOST][3], radius[MOST], emissivity[MOST], temperature[MOST], power[MOST], alone = NAN;
    uint64_t id[MOST];
    const double lost = 4 * acos(-1) * (pow(500, 4) - pow(300, 4));
    OWNED_INSITU *s;
    CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, NULL) == FIBRAD_OK);
    for (int gone = 0; gone < 2; ++gone) {
        size_t n = 0;
        for (uint64_t i = 0; i < MOST; ++i) {
            if ((gone && i == 1) || i % (uint64_t)ranks != (uint64_t)rank) continue;
            x[n][0] = 1e4 * (double)(i / 2) + 2.2 * (double)(i % 2), x[n][1] = x[n][2] = 0;
            radius[n] = emissivity[n] = 1, temperature[n] = 500, id[n++] = i;
        }
        const fibrad_insitu_bed bed = {.n = n, .id = id, .x = x[0], .radius = radius, .emissivity = emissivity};
        const fibrad_insitu_state state = {
            .sigma = 1, .surroundings = 300, .n = n, .id = id, .temperature = temperature};
        CHECK(fibrad_insitu_follow(s, &bed, 4) == FIBRAD_OK);
        CHECK(fibrad_insitu_powers(s, &state, power, NULL) == FIBRAD_OK);
        if (gone && rank == 0) alone = power[0];
    }
    if (rank == 0) CHECK(fabs(alone / -lost - 1) < 1e-6);
}

static void rows_follow_particles(double bound) {
    const struct kind kind = {"followed", 4, {1, 1, 0}, FLOORS, {.8, .5}, 0, 1, 0};
    OWNED_PILE all = pile_of(&kind), some = without(&all, 20), others = without(&all, 31);
    follow_changes(&kind, &all, &all, &some, bound);
    follow_changes(&kind, &all, &some, &all, bound);
    follow_changes(&kind, &all, &some, &others, bound);
}

/* ---- contacts -------------------------------------------------------------------------------------------------- */

/* The radius of the circle in which two spheres at a distance d cut each other, or of Hertz's spot. other 0: a wall. */
static double spot_radius(double d, double r, double other, bool hertz) {
    const double overlap = r + other - d;
    if (!(overlap > 0)) return 0;
    if (hertz) return sqrt((other > 0 ? r * other / (r + other) : r) * overlap);
    if (!(other > 0)) return sqrt(r * r - d * d);
    const double side = d * d - other * other + r * r;
    return sqrt(4 * d * d * r * r - side * side) / (2 * d);
}

/* What a sphere of the bed gains from one image of another, or from a wall, per kelvin. */
static double conductance_of_pair(const struct pile *p, const double *solid, size_t i, size_t j, const int image[3],
                                  bool hertz) {
    double square = 0;
    for (size_t axis = 0; axis < 3; ++axis)
        square += pow(p->x[3 * j + axis] + image[axis] * (p->bed.high[axis] + 1) - p->x[3 * i + axis], 2);
    const double a = spot_radius(sqrt(square), p->radius[i], p->radius[j], hertz);
    return 2 * a * 2 * solid[i] * solid[j] / (solid[i] + solid[j]);
}

static double conductance_of_wall(const struct pile *p, const double *solid, size_t i, const fibrad_wall *wall,
                                  bool hertz) {
    const double *x = p->x + 3 * i;
    const int along = wall->cylinder.along, u = along == 0, v = along == 2 ? 1 : 2;
    const double d = wall->kind == FIBRAD_WALL_PLANE
                         ? fabs(x[wall->plane.axis] - wall->plane.at)
                         : wall->cylinder.radius - hypot(x[u] - wall->cylinder.x, x[v] - wall->cylinder.y);
    return 4 * solid[i] * spot_radius(d, p->radius[i], 0, hertz);
}

/* Powers through contacts are those of all pairs of images, one by one, as means over equal parts of a step of heat.
 * scale: of spots. Heat capacities are 1. */
static void check_pairs(const struct pile *all, const double *solid, bool hertz, double scale, int parts,
                        double seconds, const double *power) {
    const size_t n = all->bed.n;
    double *t = memory_of(n, 3 * sizeof *t), *mean = t + n, *gain = mean + n, largest = 0;
    memcpy(t, all->temperature, n * sizeof *t);
    for (int part = 0; part < parts; ++part) {
        for (size_t i = 0; i < n; ++i) {
            const int *most = all->bed.periodic;
            double sum = 0;
            gain[i] = 0;
            for (size_t j = 0; j < n; ++j)
                for (int x = -most[0]; x <= most[0] && j != i; ++x)
                    for (int y = -most[1]; y <= most[1]; ++y)
                        for (int z = -most[2]; z <= most[2]; ++z) {
                            const double h =
                                scale * conductance_of_pair(all, solid, i, j, (const int[]){x, y, z}, hertz);
                            sum += h, gain[i] += h * (t[j] - t[i]);
                        }
            for (uint32_t k = 0; k < all->bed.walls; ++k) {
                const double h = scale * conductance_of_wall(all, solid, i, &all->wall[k], hertz);
                sum += h, gain[i] += h * (wall_temperature[k] - t[i]);
            }
            largest = fmax(largest, sum);
        }
        for (size_t i = 0; i < n; ++i)
            mean[i] = (part ? mean[i] : 0) + gain[i] / parts, t[i] += gain[i] * seconds / parts;
    }
    for (size_t i = 0; i < n; ++i) CHECK(fabs(power[i] - mean[i]) <= 1e-9 * largest * 1000);
    CHECK((parts > 1) == (4 * largest * seconds > 1) && 4 * largest * seconds <= parts);
    free(t);
}

/* Contacts conduct the same, to the bit, whoever owns which particle. Their powers add up to zero. */
static void contacts_conduct(const struct kind *kind, int axis, bool hertz, double gas, double seconds) {
    OWNED_PILE all = pile_of(kind);
    lay_along(&all, axis);
    for (size_t i = 0; i < all.bed.n; ++i) all.radius[i] *= 1.2;
    double *solid = memory_of(all.bed.n, 3 * sizeof *solid), *kelvin = solid + all.bed.n, *one = kelvin + all.bed.n;
    for (size_t i = 0; i < all.bed.n; ++i) solid[i] = 1 + random_of(all.id[i], 6), one[i] = 1;
    const fibrad_insitu_contacts contacts = {
        .conductivity = solid, .hertz = hertz, .scale = .7, .gas = gas, .capacity = one, .seconds = seconds};
    fibrad_insitu_conducted whole = {0}, parts = {0};
    const fibrad_insitu_config quick = {.cutoff = 4, .directions = FIBRAD_DIRECTIONS_MIN, .paths = 1};
    all.bed.conductivity = NULL;
    if (rank == 0) {
        fibrad_insitu *self;
        CHECK(fibrad_insitu_new(&self, MPI_COMM_SELF, &quick) == FIBRAD_OK);
        const fibrad_insitu_state state = state_of(&all);
        make_rows(self, &all, 7);
        CHECK(fibrad_insitu_conduct(self, &contacts, &all.bed, &state, all.power, kelvin, &whole) == FIBRAD_OK);
        fibrad_insitu_free(self);
        if (gas == 0) check_pairs(&all, solid, hertz, .7, (int)whole.parts, seconds, all.power);
    }
    OWNED_PILE part = part_of(&all, kind->spread);
    part.bed.conductivity = NULL;
    for (size_t i = 0; i < part.bed.n; ++i) solid[i] = 1 + random_of(part.id[i], 6);
    OWNED_INSITU *s;
    CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, &quick) == FIBRAD_OK);
    const fibrad_insitu_state state = state_of(&part);
    make_rows(s, &part, 7);
    CHECK(fibrad_insitu_conduct(s, &contacts, &part.bed, &state, part.power, kelvin, &parts) == FIBRAD_OK);
    double *power = gather_powers(&all, &part), largest = 0, sum = 0, left = parts.particles;
    if (rank == 0) CHECK(memcmp(power, all.power, all.bed.n * sizeof *power) == 0);
    for (size_t i = 0; i < all.bed.n; ++i) sum += power[i], largest = fmax(largest, fabs(power[i]));
    for (uint32_t k = 0; k < all.bed.walls; ++k) left += parts.wall[k];
    CHECK(largest > 0 && parts.contacts > 20 && fabs(sum - parts.particles) < 1e-12 * largest);
    CHECK(fabs(left) < 1e-12 * largest && (all.bed.walls == 0 || (parts.wall[0] != 0 && parts.conductance[0] > 0)));
    CHECK(rank > 0 || (whole.contacts == parts.contacts && whole.parts == parts.parts &&
                       fabs(whole.particles - parts.particles) < 1e-12 * largest));
    free(power);
    free(solid);
}

/* ---- refusals -------------------------------------------------------------------------------------------------- */

/* Asserts the same status and the same message on all ranks. The message contains `words`. */
static void check_refused(const fibrad_insitu *s, int status, int expected, const char *words) {
    char message[2][256] = {{0}};
    int first = status;
    snprintf(message[0], sizeof message[0], "%s", fibrad_insitu_message(s));
    memcpy(message[1], message[0], sizeof message[0]);
    MPI_Bcast(message[1], sizeof message[1], MPI_CHAR, 0, MPI_COMM_WORLD);
    MPI_Bcast(&first, 1, MPI_INT, 0, MPI_COMM_WORLD);
    CHECK(status == expected && first == status);
    CHECK(strcmp(message[0], message[1]) == 0);
    CHECK(strstr(message[0], words));
    if (!strstr(message[0], words)) fprintf(stderr, "    %s: %s\n", words, message[0]);
}

static const struct kind small = {"refused", 4, {1, 1, 0}, FLOORS, {.8, .8}, 4, 2, 0};

/* A bed with one fault. */
enum fault { TWICE, INSIDE, BAD_X, BAD_RADIUS, BAD_EMISSIVITY, BEYOND, NO_BOX, NO_WALL, ENDLESS, OUTSIDE, FAULTS };

static const fibrad_plane beneath = {2, 0, -.4};

static void spoil(struct pile *p, enum fault fault) {
    if (fault == TWICE) p->id[9] = p->id[3];
    if (fault == INSIDE) memcpy(p->x + 27, p->x + 9, 3 * sizeof *p->x), p->x[27] += .1;
    if (fault == BAD_X) p->x[10] = NAN;
    if (fault == BAD_RADIUS) p->radius[3] = -1;
    if (fault == BAD_EMISSIVITY) p->emissivity[3] = -.1;
    if (fault == BEYOND) p->x[11] = -1.5;
    if (fault == NO_BOX) p->bed.high[0] = p->bed.low[0];
    if (fault == NO_WALL) p->wall_emissivity[1] = 2;
    if (fault == ENDLESS) p->wall[1] = (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {3, 3, 9, 2}};
    if (fault == ENDLESS) memset(p->bed.periodic, 0, sizeof p->bed.periodic);
    if (fault == OUTSIDE) p->bed.opening = &beneath, p->bed.openings = 1, p->bed.walls = 1;
    if (fault == OUTSIDE) memmove(p->wall, p->wall + 1, sizeof *p->wall);
}

static void rows_are_refused(fibrad_insitu *s) {
    static const struct {
        int status;
        const char *words;
    } expected[FAULTS] = {{FIBRAD_E_ARGUMENT, "twice"},
                          {FIBRAD_E_GEOMETRY, "inside"},
                          {FIBRAD_E_ARGUMENT, "coordinate"},
                          {FIBRAD_E_ARGUMENT, "radius"},
                          {FIBRAD_E_ARGUMENT, "its emissivity"},
                          {FIBRAD_E_ARGUMENT, "beyond wall 1, zmin"},
                          {FIBRAD_E_ARGUMENT, "no extent along x"},
                          {FIBRAD_E_ARGUMENT, "wall 2"},
                          {FIBRAD_E_ENDLESS, "an opening"},
                          {FIBRAD_E_GEOMETRY, "beyond the opening"}};
    for (int fault = 0; fault < FAULTS; ++fault) {
        OWNED_PILE all = pile_of(&small);
        char named[64];
        spoil(&all, (enum fault)fault);
        OWNED_PILE part = part_of(&all, 0);
        check_refused(s, fibrad_insitu_rows(s, &part.bed, 0), expected[fault].status, expected[fault].words);
        snprintf(named, sizeof named, "%llu", (unsigned long long)all.id[3]);
        if (fault <= BEYOND) CHECK(strstr(fibrad_insitu_message(s), named));
    }
}

static void powers_are_refused(fibrad_insitu *s, const struct pile *good) {
    OWNED_PILE part = part_of(good, 0);
    char named[64] = "";
    fibrad_insitu_state state = state_of(&part);
    if (rank == ranks - 1) part.temperature[1] = 0;
    check_refused(s, fibrad_insitu_powers(s, &state, part.power, NULL), FIBRAD_E_ARGUMENT, "is not above 0");
    snprintf(named, sizeof named, "%llu", (unsigned long long)part.id[1]);
    if (rank == ranks - 1) CHECK(strstr(fibrad_insitu_message(s), named));
    part.temperature[1] = 300;
    if (rank == ranks - 1) --state.n;
    check_refused(s, fibrad_insitu_powers(s, &state, part.power, NULL), FIBRAD_E_STATE, "63 particles, but rows of 64");
    state.n = part.bed.n;
    if (rank == ranks - 1) part.id[1] = 5;
    check_refused(s, fibrad_insitu_powers(s, &state, part.power, NULL), FIBRAD_E_STATE, "make new rows");
    part.id[1] = part.id[0];
    check_refused(s, fibrad_insitu_powers(s, &state, part.power, NULL), FIBRAD_E_STATE, "make new rows");
    state.surroundings = -1;
    check_refused(s, fibrad_insitu_powers(s, &state, part.power, NULL), FIBRAD_E_ARGUMENT, "surroundings");
}

/* Radii in another unit than positions, and walls in a wrong place, are refused at once. */
static void wrong_units_are_refused(void) {
    strict = 0;
    const struct kind open = {"units", 6, {0, 0, 0}, OPEN, {.8, .8}, 0, 1, 0},
                      floors = {"units", 6, {0, 0, 0}, FLOORS, {.8, .8}, 0, 1, 0};
    for (int fault = 0; fault < 3; ++fault) {
        OWNED_PILE all = pile_of(fault < 2 ? &open : &floors);
        for (size_t i = 0; i < all.bed.n && fault < 2; ++i) all.radius[i] *= 100;
        if (fault == 1) all.bed.periodic[1] = 1;
        if (fault == 2) all.wall[0].plane.at += PITCH;
        OWNED_PILE part = part_of(&all, 0);
        OWNED_INSITU *s = insitu_of(MPI_COMM_WORLD, &open, 1);
        check_refused(s, fibrad_insitu_rows(s, &part.bed, 0), FIBRAD_E_GEOMETRY,
                      fault == 0   ? "is its diameter right"
                      : fault == 1 ? "more than the period along y"
                                   : "36 of 216 particles cannot take part; particle");
    }
}

/* What a cylinder along x or y may not have. A message names the axes of the bed. */
static void cylinders_are_refused(fibrad_insitu *s) {
    static const char *const place[] = {"at (0.5, 9.5, 0.25): its centre lies beyond wall 1, the cylinder",
                                        "at (0.25, 0.5, 9.5): its centre lies beyond wall 1, the cylinder"};
    for (int axis = 0; axis < 2; ++axis) {
        fibrad_wall tube = {.kind = FIBRAD_WALL_CYLINDER, .cylinder = {3, 4, 6, axis}};
        const fibrad_plane across[] = {{2, 0, -1}, {2, 1, 9}};
        const fibrad_wall both[] = {tube, tube}, floor[] = {tube, {.kind = FIBRAD_WALL_PLANE, .plane = across[0]}};
        double x[3] = {9.5, .25, .5};
        turn_axes(x, axis);
        fibrad_insitu_bed bed = {.low = {0}, .high = {9, 9, 9}};
        bed.periodic[axis] = 1, bed.wall_emissivity = (const double[]){1, 1};
        bed.n = 1, bed.id = &(const uint64_t){5}, bed.x = x, bed.radius = bed.emissivity = &(const double){.5};
        bed.wall = &tube, bed.walls = 1;
        check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ARGUMENT, place[axis]);
        bed.wall = both, bed.walls = 2;
        check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ARGUMENT, "do not bound a box or a cylinder");
        bed.wall = floor;
        check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ARGUMENT,
                      "do not bound a box or a cylinder: wall 1 is a cylinder, and across it lies wall 2 at");
        bed.walls = 1, bed.opening = across, bed.openings = 2;
        check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ARGUMENT, "do not bound a box or a cylinder");
        bed.openings = 0, bed.periodic[axis] = 0;
        check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ENDLESS, "an opening");
        tube.cylinder.along = 3, bed.wall = &tube;
        check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ARGUMENT, "");
    }
}

/* The message names planes that cross, whatever meshes stand before them. */
static void walls_that_cross_are_refused(fibrad_insitu *s) {
    const fibrad_wall wall[] = {{.kind = FIBRAD_WALL_MESH},
                                {.kind = FIBRAD_WALL_PLANE, .plane = {2, 1, 3}},
                                {.kind = FIBRAD_WALL_PLANE, .plane = {2, 0, 5}}};
    fibrad_insitu_bed bed = {.wall = wall, .walls = 3, .wall_emissivity = (const double[]){1, 1, 1}};
    check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ARGUMENT, "wall 3 at 5 does not lie below wall 2 at 3");
    const fibrad_wall twice[] = {wall[0], wall[1], wall[1]};
    bed.wall = twice;
    check_refused(s, fibrad_insitu_rows(s, &bed, 0), FIBRAD_E_ARGUMENT,
                  "wall 2 at 3 is on the same side as wall 3 at 3");
}

/* If one rank cannot write its file, no file is left. */
static void files_are_refused(fibrad_insitu *s) {
    char name[4200];
    snprintf(name, sizeof name, "%s.%d.rows.tmp", path_of("refused"), ranks - 1);
    if (rank == 0) CHECK(mkdir(name, 0700) == 0);
    MPI_Barrier(MPI_COMM_WORLD);
    check_refused(s, fibrad_insitu_write(s, path_of("refused")), FIBRAD_E_FILE, name);
    MPI_Barrier(MPI_COMM_WORLD);
    remove(name);
    snprintf(name, sizeof name, "%s.%d.rows", path_of("refused"), rank);
    CHECK(remove(name) != 0);
    check_refused(s, fibrad_insitu_write(s, NULL), FIBRAD_E_ARGUMENT, "is empty or too long");
}

/* Contacts of particles that conduct inside, and of conductivities that are not above 0 or do not ascend. */
static void contacts_are_refused(fibrad_insitu *s, const struct pile *good) {
    OWNED_PILE part = part_of(good, 0);
    const fibrad_insitu_state state = state_of(&part);
    double *solid = memory_of(part.bed.n, 2 * sizeof *solid), *kelvin = solid + part.bed.n;
    for (size_t i = 0; i < part.bed.n; ++i) solid[i] = 2;
    fibrad_insitu_contacts contacts = {.conductivity = solid};
    check_refused(s, fibrad_insitu_conduct(s, &contacts, &part.bed, &state, part.power, kelvin, NULL),
                  FIBRAD_E_UNSUPPORTED, "not particles that conduct inside");
    part.bed.conductivity = NULL;
    contacts.gas_temperature = contacts.gas_conductivity = (const double[]){300, 300}, contacts.gas_rows = 2;
    check_refused(s, fibrad_insitu_conduct(s, &contacts, &part.bed, &state, part.power, kelvin, NULL),
                  FIBRAD_E_ARGUMENT, "");
    contacts.gas_rows = 0, contacts.wall = -1;
    check_refused(s, fibrad_insitu_conduct(s, &contacts, &part.bed, &state, part.power, kelvin, NULL),
                  FIBRAD_E_ARGUMENT, "");
    contacts.wall = 0;
    if (rank == ranks - 1) solid[1] = 0;
    check_refused(s, fibrad_insitu_conduct(s, &contacts, &part.bed, &state, part.power, kelvin, NULL),
                  FIBRAD_E_ARGUMENT, "its conductivity at contacts must be above 0, not 0");
    free(solid);
}

/* Particles that conduct very little: rows of few paths do not tell their powers, and rows of many paths do. */
static void rows_are_too_inaccurate(void) {
    static const uint32_t paths[] = {24, 600};
    conducting = 1e-3;
    OWNED_PILE all = pile_of(&small), part = part_of(&all, 0);
    conducting = 0;
    const fibrad_insitu_state state = state_of(&part);
    for (int enough = 0; enough < 2; ++enough) {
        OWNED_INSITU *s;
        const fibrad_insitu_config config = {
            .cutoff = small.cutoff, .directions = 50, .paths = paths[enough], .seed = 3, .threads = 2};
        CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, &config) == FIBRAD_OK);
        make_rows(s, &part, 0);
        const int status = fibrad_insitu_powers(s, &state, part.power, NULL);
        if (enough)
            CHECK(status == FIBRAD_OK);
        else
            check_refused(s, status, FIBRAD_E_UNSOLVABLE, "take more paths");
    }
}

/* After all refusals the object is as before. */
static void refusals(void) {
    OWNED_INSITU *s = NULL;
    CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, &(fibrad_insitu_config){.cutoff = -1}) == FIBRAD_E_ARGUMENT && !s);
    CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, &(fibrad_insitu_config){.accuracy = 3}) == FIBRAD_E_ARGUMENT && !s);
    CHECK(fibrad_accuracy_named("normal") == FIBRAD_ACCURACY_NORMAL);
    CHECK(fibrad_accuracy_named("low") == FIBRAD_ACCURACY_LOW);
    CHECK(fibrad_accuracy_named("high") == FIBRAD_ACCURACY_HIGH);
    CHECK(fibrad_accuracy_named("") == -1 && fibrad_accuracy_named("High") == -1 && fibrad_accuracy_named(NULL) == -1);
    CHECK(fibrad_insitu_new(&s, MPI_COMM_WORLD, &(fibrad_insitu_config){.threads = rank == 0 ? -1 : 1}) ==
              FIBRAD_E_ARGUMENT &&
          !s);
    CHECK(strcmp(fibrad_insitu_message(NULL), "") == 0);
    strict = 1;
    s = insitu_of(MPI_COMM_WORLD, &small, 2);
    OWNED_PILE all = pile_of(&small), part = part_of(&all, 0);
    const fibrad_insitu_state state = state_of(&part);
    FREED double *before = memory_of(part.bed.n, sizeof *before);
    check_refused(s, fibrad_insitu_powers(s, &state, before, NULL), FIBRAD_E_STATE, "there are no rows yet");
    check_refused(s, fibrad_insitu_write(s, path_of("refused")), FIBRAD_E_STATE, "no rows");
    make_rows(s, &part, 3);
    CHECK(fibrad_insitu_powers(s, &state, before, NULL) == FIBRAD_OK);
    rows_are_refused(s);
    powers_are_refused(s, &all);
    files_are_refused(s);
    contacts_are_refused(s, &all);
    CHECK(fibrad_insitu_powers(s, &state, part.power, NULL) == FIBRAD_OK);
    CHECK(memcmp(before, part.power, part.bed.n * sizeof *before) == 0);
    cylinders_are_refused(s);
    walls_that_cross_are_refused(s);
    fibrad_insitu_free(s);

    s = insitu_of(MPI_COMM_WORLD, &(struct kind){.cutoff = 1000}, 1);
    check_refused(s, fibrad_insitu_rows(s, &part.bed, 0), FIBRAD_E_ARGUMENT, "more than 100 periods along x");
    part.bed.n = 0; /* a bed without particles */
    const fibrad_insitu_state none = state_of(&part);
    fibrad_insitu_totals totals = {.particles = 1};
    CHECK(fibrad_insitu_rows(s, &(fibrad_insitu_bed){0}, 0) == FIBRAD_OK);
    CHECK(fibrad_insitu_powers(s, &none, NULL, &totals) == FIBRAD_OK && totals.particles == 0);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    folder = argc > 1 ? argv[1] : ".";
    things_arrive();
    links();
    for (int k = 0; k < KINDS; ++k) rows_are_those_of_one_rank(&kinds[k], 2);
    for (int k = 0; k < KINDS; ++k)
        for (int axis = 0; axis < 2 && kinds[k].walls >= TUBE; ++axis) rows_are_those_of_one_rank(&kinds[k], axis);
    for (int k = 0; k < KINDS; ++k) powers_keep_energy(&kinds[k]);
    for (int k = 0; k < KINDS; ++k) powers_of_rows_made_again(&kinds[k]);
    steps_change_noise();
    the_map_has_all(&kinds[0]);
    the_map_has_all(&kinds[4]);
    the_sky_stays_open();
    unknown_parts_are_told(OPEN);
    unknown_parts_are_told(FLOORS);
    large_particles_are_seen();
    temperatures_are_those_of_the_kernel(OPEN);
    temperatures_are_those_of_the_kernel(FLOORS);
    strays_do_not_end_a_run();
    rows_follow_particles(.12);
    what_goes_is_given_back();
    gather = 10; /* a bed with more particles than each rank may have */
    rows_are_those_of_one_rank(&kinds[5], 2);
    powers_keep_energy(&kinds[5]);
    gather = 0;
    conducting = .1;
    rows_are_those_of_one_rank(&kinds[0], 2);
    powers_keep_energy(&kinds[3]);
    powers_keep_energy(&kinds[7]);
    rows_follow_particles(.15);
    conducting = 0;
    a_lone_particle();
    walls_exchange_with_each_other();
    for (int k = 0; k < KINDS; ++k) {
        for (int axis = kinds[k].walls >= TUBE ? 0 : 2; axis < 3; ++axis)
            contacts_conduct(&kinds[k], axis, k % 2, axis < 2 || k == 4 ? .3 : 0, 0);
        contacts_conduct(&kinds[k], 2, k % 2, 0, .3);
    }
    refusals();
    wrong_units_are_refused();
    rows_are_too_inaccurate();
    int sum[2] = {checks, failures};
    MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0) printf("%d ranks: %d checks, %d failures\n", ranks, sum[0], sum[1]);
    MPI_Finalize();
    return sum[1] != 0;
}
