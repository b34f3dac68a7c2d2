# couple.mk - couplings with codes that divide particles over MPI ranks; included by Makefile. SPDX-License-Identifier: MIT
#
# Open MPI's wrappers know the flags; whatever is missing is named when it is needed.

MPICC  = mpicc
MPICXX = mpicxx
MPIRUN = mpirun

COUPLE := $(filter-out host/couple/example.c,$(call sources,host/couple/*.c host/couple/ranks/*.c))

COUPLE_WALLS = $(call sources,host/couple/simulation/*.c)

# walls of triangles and tables, for programs that read files of them; a library of its own, since it has names of the program
COUPLE_MESH = $(COUPLE_WALLS) \
    host/bed/wall_words.c \
    host/cli/interrupt.c \
    host/cli/memory.c \
    host/cli/message.c \
    host/cli/output.c \
    host/cli/spelling.c \
    host/mesh/edges.c \
    host/mesh/facing.c \
    host/mesh/meshes.c \
    host/mesh/sides.c \
    host/mesh/stl.c \
    host/mesh/weld.c \
    host/text/header.c \
    host/text/read_curve.c \
    host/text/read_lines.c \
    host/text/read_number.c \
    host/text/unit.c

# programs of one file each, with their own main
COUPLE_PROGRAMS = host/couple/example.c

COUPLE_TESTS   = tests/couple/test_couple.c
COUPLE_SCRIPTS = tests/couple/check_couple.sh tests/couple/check_made.sh

COUPLE_OBJECTS = $(COUPLE:%.c=$(BUILD)/%.o)
# of the simple layer, which users need not link: contacts; threads and their memory
COUPLE_SIMPLE = $(patsubst %,$(BUILD)/host/simple/%.o,contact_list find_contacts triangle_contacts heap team)
COUPLE_MESH_OBJECTS = $(COUPLE_MESH:%.c=$(BUILD)/couple/%.o)
COUPLE_MESH_LIB     = $(BUILD)/couple/libmesh_walls.a
COUPLE_LIBS    = $(BUILD)/couple/libfibrad_couple.a $(BUILD)/libfibrad.a
COUPLE_CXX     = $(CFLAGS) -pedantic -Wall -Wextra -Wshadow $(WERROR) -DOMPI_SKIP_MPICXX -Ikernel -Ihost -MMD -MP
COUPLE_FLAGS   = $(COMMON) -D_POSIX_C_SOURCE=200809L -fopenmp -Ihost $(PIC)

# what `make couple` builds; what it needs is looked for when the first file is to be made, since deps-couple may have to install it
COUPLE_PRODUCTS = $(BUILD)/couple/libfibrad_couple.a $(BUILD)/couple/example
COUPLE_DEPS     = $(filter deps-couple,$(MAKECMDGOALS))

# couplings with other codes add to these lists
include $(wildcard host/couple/lammps/*.mk host/couple/liggghts/*.mk)

# what docs/lammps.md rests on: mpirun -np 2 build/couple/ranks tests/data/monoper2000.dump 2 0.8
$(BUILD)/couple/ranks: bench/ranks.c bench/messages.h $(COUPLE_LIBS)
	$(MPICC) $(CFLAGS) $(COUPLE_FLAGS) $(LDFLAGS) $< $(COUPLE_LIBS) -lm -o $@

## couple: libfibrad_couple.a, fix fibrad of LAMMPS and the driver of LIGGGHTS, into build/couple (on a fresh machine: make deps-couple couple)
.PHONY: couple couple-lib install-couple need-mpi test-couple deps-couple

couple: $(COUPLE_PRODUCTS)

## couple-lib: libfibrad_couple.a and its example alone (needs MPI)
couple-lib: $(BUILD)/couple/libfibrad_couple.a $(BUILD)/couple/example

## install-couple: install-lib, and libfibrad_couple.a with its header and .pc file
install-couple: install-lib $(BUILD)/couple/libfibrad_couple.a
	install -m 644 host/couple/fibrad_couple.h $(DESTDIR)$(PREFIX)/include
	install -m 644 $(BUILD)/couple/libfibrad_couple.a $(DESTDIR)$(PREFIX)/lib
	$(call install_pc,host/couple/fibrad_couple.pc.in)

$(BUILD)/couple/libfibrad_couple.a: $(COUPLE_OBJECTS) $(COUPLE_SIMPLE)
	@mkdir -p $(@D)
	rm -f $@
	$(AR) rcs $@ $(COUPLE_OBJECTS) $(COUPLE_SIMPLE)

$(COUPLE_OBJECTS): $(BUILD)/%.o: %.c | need-mpi
	@mkdir -p $(@D)
	$(MPICC) $(CFLAGS) $(COUPLE_FLAGS) -c $< -o $@

$(COUPLE_MESH_LIB): $(COUPLE_MESH_OBJECTS)
	rm -f $@
	$(AR) rcs $@ $(COUPLE_MESH_OBJECTS)

$(COUPLE_MESH_OBJECTS): $(BUILD)/couple/%.o: %.c | need-mpi
	@mkdir -p $(@D)
	$(MPICC) $(CFLAGS) $(COMMON) -D_XOPEN_SOURCE=700 -Ihost $(ZLIB_CFLAGS) $(PIC) -c $< -o $@

$(BUILD)/couple/example: host/couple/example.c $(COUPLE_LIBS)
	$(MPICC) $(CFLAGS) $(COUPLE_FLAGS) $(LDFLAGS) $< $(COUPLE_LIBS) -lm -o $@

$(BUILD)/couple/test_couple: tests/couple/test_couple.c $(COUPLE_LIBS)
	$(MPICC) $(CFLAGS) $(COUPLE_FLAGS) $(LDFLAGS) $< $(COUPLE_LIBS) -lm -o $@

need-mpi: | $(COUPLE_DEPS)
	@command -v $(MPICC) >/dev/null || { echo "Couplings need MPI: run 'make deps-couple' (Debian: openmpi-bin," \
	    "libopenmpi-dev)." >&2; exit 1; }

$(COUPLE_OBJECTS) $(COUPLE_MESH_OBJECTS) $(COUPLE_PRODUCTS): Makefile host/couple/couple.mk

-include $(COUPLE_OBJECTS:.o=.d) $(COUPLE_MESH_OBJECTS:.o=.d) $(BUILD)/couple/example.d $(BUILD)/couple/test_couple.d

## test-couple: build and run all tests of the couplings, in minutes; without packages they are skipped, with a message
test-couple:
	for coupling in couple lammps liggghts; do $(WITH_MPI) tests/couple/check_$$coupling.sh all || exit; done
	for rest in pages made; do $(WITH_MPI) tests/couple/check_$$rest.sh || exit; done

## deps-couple: install the Debian packages of the couplings: MPI, LAMMPS, LIGGGHTS
deps-couple:
	@$(DEPS) libc6-dev g++ pkg-config zlib1g-dev openmpi-bin libopenmpi-dev lammps liblammps-dev liggghts libliggghts-dev
