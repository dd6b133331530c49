/* Time of CHOLMOD's supernodal solver with one ordering, for a matrix of the bench direct_solver:
   cc -O2 cholmod.c -lcholmod -o cholmod; ./cholmod NAME FILE amd|metis */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>
#include <time.h>

enum { REPEATS = 9, STEPS = 5 };

static double seconds(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void need(size_t read, size_t wanted) {
    if (read != wanted) {
        fprintf(stderr, "the file is too short\n");
        exit(1);
    }
}

static cholmod_sparse *matrix(FILE *file, cholmod_dense **right, cholmod_common *common) {
    uint32_t counts[2];
    need(fread(counts, sizeof counts, 1, file), 1);
    int n = (int)counts[0];
    cholmod_sparse *a = cholmod_allocate_sparse(n, n, counts[1], 1, 1, -1, CHOLMOD_REAL, common);
    need(fread(a->p, sizeof(int), n + 1, file), n + 1);
    need(fread(a->i, sizeof(int), counts[1], file), counts[1]);
    need(fread(a->x, sizeof(double), counts[1], file), counts[1]);
    *right = cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, common);
    need(fread((*right)->x, sizeof(double), n, file), n);
    /* The rows of a column need not ascend. */
    a->sorted = 0;
    cholmod_sort(a, common);
    return a;
}

/* Largest component of Kx - f over the sum of those of |K||x| and |f|. */
static double backward_error(cholmod_sparse *a, cholmod_dense *x, cholmod_dense *f, cholmod_common *common) {
    double minus[2] = {-1, 0}, one[2] = {1, 0};
    cholmod_dense *residual = cholmod_copy_dense(f, common);
    cholmod_sdmult(a, 0, minus, one, x, residual, common);
    double largest = cholmod_norm_dense(residual, 0, common);
    double size = cholmod_norm_sparse(a, 0, common) * cholmod_norm_dense(x, 0, common);
    double error = largest / (size + cholmod_norm_dense(f, 0, common));
    cholmod_free_dense(&residual, common);
    return error;
}

int main(int count, char **arguments) {
    if (count != 4) return 2;
    cholmod_common common;
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = strcmp(arguments[3], "metis") ? CHOLMOD_AMD : CHOLMOD_METIS;
    common.postorder = 1;
    FILE *file = fopen(arguments[2], "rb");
    if (!file) return 1;
    cholmod_dense *right;
    cholmod_sparse *a = matrix(file, &right, &common);
    double times[STEPS][REPEATS], error = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double start = seconds(CLOCK_MONOTONIC), processor = seconds(CLOCK_PROCESS_CPUTIME_ID);
        cholmod_factor *factor = cholmod_analyze(a, &common);
        double analysed = seconds(CLOCK_MONOTONIC);
        cholmod_factorize(a, factor, &common);
        double factorised = seconds(CLOCK_MONOTONIC);
        cholmod_dense *x = cholmod_solve(CHOLMOD_A, factor, right, &common);
        double solved = seconds(CLOCK_MONOTONIC);
        times[0][repeat] = analysed - start;
        times[1][repeat] = factorised - analysed;
        times[2][repeat] = solved - factorised;
        times[3][repeat] = solved - start;
        times[4][repeat] = seconds(CLOCK_PROCESS_CPUTIME_ID) - processor;
        error = backward_error(a, x, right, &common);
        cholmod_free_dense(&x, &common);
        cholmod_free_factor(&factor, &common);
    }
    /* Ordering and analysis are one step here. */
    printf("%s cholmod-%s -", arguments[1], arguments[3]);
    for (int step = 0; step < STEPS; step++) {
        qsort(times[step], REPEATS, sizeof(double), compare);
        printf(" %.3f", times[step][REPEATS / 2]);
    }
    printf(" %.2e %.2e %.1e\n", common.lnz, common.fl, error);
    return 0;
}
