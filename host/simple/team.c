/* team.c - the threads of a call, by OpenMP. SPDX-License-Identifier: MIT */
#include "simple/team.h"

#include <omp.h>
#include <stdlib.h>

#define THREADS_MAX 1024

int fibrad_team_open(fibrad_team *team, const fibrad_run *run) {
    const int most = omp_get_max_threads();
    *team = (fibrad_team){.threads = most < THREADS_MAX ? most : THREADS_MAX, .triangle = UINT32_MAX};
    if (run && (run->threads < 0 || run->threads > THREADS_MAX)) return FIBRAD_E_ARGUMENT;
    if (run && run->threads) team->threads = run->threads;
    if (run) team->progress = run->progress, team->context = run->context;
    team->work = calloc((size_t)team->threads, sizeof *team->work);
    team->rows = calloc((size_t)team->threads, sizeof *team->rows);
    team->store = calloc((size_t)team->threads, sizeof *team->store);
    team->error = calloc((size_t)team->threads, sizeof *team->error);
    if (!team->work || !team->rows || !team->store || !team->error) return FIBRAD_E_MEMORY;
    for (int t = 0; t < team->threads; ++t) {
        team->work[t].memory.resize = fibrad_heap_resize;
        team->rows[t].memory = (fibrad_memory){.resize = fibrad_scratch_resize, .context = &team->store[t]};
    }
    return FIBRAD_OK;
}

void fibrad_team_close(fibrad_team *team) {
    for (int t = 0; t < team->threads; ++t) {
        if (team->work) free(team->work[t].memory.block);
        if (team->store) fibrad_scratch_close(&team->store[t]);
    }
    free(team->work);
    free(team->rows);
    free(team->store);
    free(team->error);
    *team = (fibrad_team){0};
}

void fibrad_team_forget(fibrad_team *team) {
    for (int t = 0; t < team->threads; ++t) {
        fibrad_scratch_close(&team->store[t]);
        team->rows[t] = (fibrad_rows){.memory = {.resize = fibrad_scratch_resize, .context = &team->store[t]}};
    }
}

int fibrad_team_scratch(fibrad_team *team, const char *folder) {
    int status = FIBRAD_OK;
    for (int t = 0; t < team->threads && !status; ++t) status = fibrad_scratch_open(&team->store[t], folder);
    return status;
}

int fibrad_team_report(const fibrad_team *team, const char *stage, uint64_t done, uint64_t total) {
    if (!stage || !team->progress || !team->progress(team->context, stage, done, total)) return FIBRAD_OK;
    return FIBRAD_E_CANCELLED;
}

/* Tasks are begun in ascending order. A task that fails stops only tasks behind it. So the lowest task that fails is
 * found whatever the schedule. */
static void run_tasks(fibrad_team *team, const char *stage, uint32_t tasks, int chunk, fibrad_team_task *task,
                      void *job) {
    uint32_t end = tasks; /* a task that failed; tasks behind it are not begun */
    uint64_t done = 0;
#pragma omp parallel num_threads(team->threads)
    {
        const int thread = omp_get_thread_num();
        fibrad_team_error *error = &team->error[thread];
        double reported = omp_get_wtime();
#pragma omp for schedule(dynamic, chunk)
        for (uint32_t k = 0; k < tasks; ++k) {
            uint32_t last;
            uint64_t count;
#pragma omp atomic read
            last = end;
            if (k >= last) continue;
            int status = task(job, thread, k);
#pragma omp atomic capture
            count = ++done;
            uint32_t at = k;
            if (!status && thread == 0 && count < tasks && omp_get_wtime() - reported > TEAM_INTERVAL) {
                status = fibrad_team_report(team, stage, count, tasks);
                if (status) at = 0;
                reported = omp_get_wtime();
            }
            if (!status || error->status == FIBRAD_E_CANCELLED || (error->status && error->task < at)) continue;
            *error =
                (fibrad_team_error){at, status, status == FIBRAD_E_BACK ? team->work[thread].triangle : UINT32_MAX};
#pragma omp atomic write
            end = at;
        }
    }
}

int fibrad_team_run(fibrad_team *team, const char *stage, uint32_t tasks, int chunk, fibrad_team_task *task, void *job,
                    uint32_t *failed) {
    uint32_t lowest = tasks;
    int status = fibrad_team_report(team, stage, 0, tasks);
    if (failed) *failed = tasks;
    team->triangle = UINT32_MAX;
    if (status) return status;
    for (int t = 0; t < team->threads; ++t) team->error[t] = (fibrad_team_error){0};
    run_tasks(team, stage, tasks, chunk, task, job);
    for (int t = 0; t < team->threads; ++t) {
        const fibrad_team_error *error = &team->error[t];
        if (error->status == FIBRAD_E_CANCELLED) return FIBRAD_E_CANCELLED;
        if (error->status && error->task < lowest)
            lowest = error->task, status = error->status, team->triangle = error->triangle;
    }
    if (failed) *failed = lowest;
    return status ? status : fibrad_team_report(team, stage, tasks, tasks);
}

void fibrad_team_share(void *team, uint32_t pieces, fibrad_piece *piece, void *job) {
    const fibrad_team *all = team;
#pragma omp parallel for schedule(dynamic) num_threads(all->threads)
    for (uint32_t k = 0; k < pieces; ++k) piece(job, k);
}
