/* The diamond of `diamond.rs` refined by ALBERTA, for the table of `speed.rs`.
 *
 * Debian: apt install libalberta-dev
 * cc -O3 -DDIM_OF_WORLD=2 -DALBERTA_DEBUG=0 -I/usr/include/alberta alberta.c -lalberta_2d -lalberta_utilities -lm
 *
 * Prints the number of triangles and the seconds for marking and refining.
 */
#include <alberta.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { CELLS = 20 };

/* 20 x 20 cells of side 1 on (-10, 10)^2, each two triangles; the refinement edge joins the first two vertices. */
static void write_grid(FILE *file)
{
    int side = CELLS + 1;
    fprintf(file, "DIM: 2\nDIM_OF_WORLD: 2\nnumber of vertices: %d\nnumber of elements: %d\n", side * side,
            2 * CELLS * CELLS);
    fprintf(file, "vertex coordinates:\n");
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            fprintf(file, "%d %d\n", x - CELLS / 2, y - CELLS / 2);
    fprintf(file, "element vertices:\n");
    for (int y = 0; y < CELLS; y++)
        for (int x = 0; x < CELLS; x++) {
            int a = y * side + x, b = a + 1, c = a + side, d = c + 1;
            fprintf(file, "%d %d %d\n%d %d %d\n", b, c, a, c, b, d);
        }
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

/* Marks what has more than the target diameter and a vertex in the diamond. */
static int mark(MESH *mesh, double target)
{
    int marked = 0;
    TRAVERSE_FIRST(mesh, -1, CALL_LEAF_EL | FILL_COORDS) {
        const REAL_D *p = (const REAL_D *)el_info->coord;
        double diameter = hypot(p[0][0] - p[1][0], p[0][1] - p[1][1]);
        int inside = 0;
        for (int i = 0; i < 3; i++)
            inside |= fabs(p[i][0]) + fabs(p[i][1]) < 8.0;
        el_info->el->mark = diameter > target && inside;
        marked |= el_info->el->mark;
    } TRAVERSE_NEXT();
    return marked;
}

int main(int count, char **arguments)
{
    int level = count > 1 ? atoi(arguments[1]) : 13;
    char name[] = "/tmp/alberta-XXXXXX";
    FILE *file = fdopen(mkstemp(name), "w");
    write_grid(file);
    fclose(file);
    MACRO_DATA *data = read_macro(name);
    MESH *mesh = GET_MESH(2, "square", data, NULL, NULL);
    free_macro_data(data);
    unlink(name);
    double target = sqrt(2.0) * pow(0.5, 0.5 * level) * (1.0 + 1e-6);
    double began = seconds();
    while (mark(mesh, target))
        refine(mesh, FILL_NOTHING);
    printf("%d %.6f\n", mesh->n_elements, seconds() - began);
    return 0;
}
