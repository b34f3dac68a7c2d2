/* write_furnace.c - writes the fields of a box. SPDX-License-Identifier: MIT */
#include "papers/furnace/furnace.h"

#include "text/text.h"

void write_furnace_csv(FILE *file, const struct furnace_run *run) {
    const fibrad_furnace_config *c = &run->config;
    double step[3];
    size_t cell = 0;
    for (int a = 0; a < 3; a++) step[a] = c->size[a] / c->cells[a];
    fputs("x,y,z,T,E,divq\n", file);
    for (uint32_t k = 0; k < c->cells[2]; k++) {
        for (uint32_t j = 0; j < c->cells[1]; j++) {
            for (uint32_t i = 0; i < c->cells[0]; i++, cell++) {
                double e = run->at.e[cell];
                const double values[] = {
                    (i + 0.5) * step[0],     (j + 0.5) * step[1], (k + 0.5) * step[2], fibrad_furnace_temperature(e), e,
                    run->at.divergence[cell]};
                char line[6 * TEXT_NUMBER], *at = line;
                for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
                    at = text_real(at, values[v]);
                    *at++ = v < 5 ? ',' : '\n';
                }
                fwrite(line, 1, (size_t)(at - line), file);
            }
        }
    }
}

static void furnace_write_field(FILE *file, const struct furnace_run *run, const char *name, const double *values,
                                bool temperature) {
    const uint32_t *n = run->config.cells;
    size_t cells = (size_t)n[0] * n[1] * n[2];
    fprintf(file, "        <DataArray type=\"Float64\" Name=\"%s\" format=\"ascii\">\n", name);
    for (size_t k = 0; k < cells; k++)
        fprintf(file, "%.17g\n", temperature ? fibrad_furnace_temperature(values[k]) : values[k]);
    fputs("        </DataArray>\n", file);
}

void write_furnace_vti(FILE *file, const struct furnace_run *run) {
    const fibrad_furnace_config *c = &run->config;
    const uint32_t *n = c->cells;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"ImageData\" version=\"0.1\">\n"
            "  <ImageData WholeExtent=\"0 %u 0 %u 0 %u\" Origin=\"0 0 0\" Spacing=\"%.17g %.17g %.17g\">\n"
            "    <Piece Extent=\"0 %u 0 %u 0 %u\">\n"
            "      <CellData Scalars=\"T\">\n",
            n[0], n[1], n[2], c->size[0] / n[0], c->size[1] / n[1], c->size[2] / n[2], n[0], n[1], n[2]);
    furnace_write_field(file, run, "T", run->at.e, true);
    furnace_write_field(file, run, "E", run->at.e, false);
    furnace_write_field(file, run, "divq", run->at.divergence, false);
    fputs("      </CellData>\n    </Piece>\n  </ImageData>\n</VTKFile>\n", file);
}
