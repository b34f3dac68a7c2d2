/* test_scenes.c - a run of the program makes one scene of the spheres of a bed. SPDX-License-Identifier: MIT
 *
 * The linker puts __wrap_fibrad_scene_init in the place of the kernel's function (Makefile). */
#include "command/commands.h"
#include "program.h"
#include "simple/fibrad_host.h"
#include "suite.h"

FIXTURE(make_folder, remove_folder)

static int scenes;

int __real_fibrad_scene_init(fibrad_scene **scene, void *memory, size_t size, const fibrad_scene_config *config,
                             const fibrad_spheres *spheres, fibrad_fault *fault);
int __wrap_fibrad_scene_init(fibrad_scene **scene, void *memory, size_t size, const fibrad_scene_config *config,
                             const fibrad_spheres *spheres, fibrad_fault *fault);

int __wrap_fibrad_scene_init(fibrad_scene **scene, void *memory, size_t size, const fibrad_scene_config *config,
                             const fibrad_spheres *spheres, fibrad_fault *fault) {
    scenes += spheres && spheres->n > 0;
    return __real_fibrad_scene_init(scene, memory, size, config, spheres, fault);
}

static const char bed[] = "x,y,z,radius,T\n0,0,0,1,500\n2.1,0,0,1,900\n0,1.9,0,1,700\n2,2,0,1,600\n1,1,1.5,.8,800\n";
static const char stl[] = "solid s\nfacet normal 0 0 1\nouter loop\nvertex -9 -9 -2\nvertex 9 -9 -2\nvertex 0 9 -2\n"
                          "endloop\nendfacet\nendsolid s\n";

#define BED    "BED", "--length-unit", "m", "--threads", "1", "--quiet"
#define HEAT   "heat", BED, "--emissivity", ".6", "--ambient", "300", "--temperature", "T"
#define MESH   "--wall", "mesh:STL:both:temperature=900"
#define STORES "--until", "1e4", "--heat-capacity", "800", "--density", "2500"

/* BED and STL stand for files. */
static const char *const runs[][32] = {
    {"factors", BED},
    {"factors", BED, "--wall", "mesh:STL:both", "--wall-vtp", "VTP"},
    {"factors", BED, "--error", "1e-4"},
    {"factors", BED, "--emissivity", ".5", "--wall", "zmin"},
    {HEAT},
    {HEAT, MESH},
    {HEAT, "--error", ".003"},
    {HEAT, "--contacts", "lens", "--contact-conductivity", "2"},
    {HEAT, "--irradiate", "0,0,-1:1000"},
    {HEAT, STORES},
    {HEAT, STORES, "--irradiate", "0,0,-1:1000", "--times", "0,5e3,1e4"},
    {HEAT, "--wall", "xmin:insulated,xmax:insulated,ymin:insulated,ymax:insulated,zmin:temperature=300,zmax:open",
     "--face"},
};
enum { RUNS = sizeof runs / sizeof *runs };

LOOP_TEST(one_scene_a_bed, RUNS) {
    char *words[32], mesh[600];
    const char *const *given = runs[_i];
    int count = 0;
    for (; given[count]; ++count) {
        const char *word = given[count], *file = strstr(word, "STL");
        snprintf(mesh, sizeof mesh, "%.*s%s%s", file ? (int)(file - word) : 0, word,
                 file ? write_file("m.stl", stl) : "", file ? file + 3 : "");
        words[count] = strdup(file                       ? mesh
                              : strcmp(word, "BED") == 0 ? write_file("bed.csv", bed)
                              : strcmp(word, "VTP") == 0 ? in_folder("walls.vtp")
                                                         : word);
    }
    words[count] = NULL;
    scenes = 0;
    const int status =
        strcmp(words[0], "heat") == 0 ? command_heat(count - 1, words + 1) : command_factors(count - 1, words + 1);
    ck_assert_int_eq(status, 0);
    ck_assert_int_eq(scenes, 1);
    for (int k = 0; k < count; ++k) free(words[k]);
}
