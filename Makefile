# Makefile - builds libfibrad.a (kernel), libfibrad_host.a (simple layer), libfibrad.so (both) and fibrad (program); `make help` lists the targets. SPDX-License-Identifier: MIT

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SUFFIXES:
# numbers of awk, order of sort, words of compilers
export LC_ALL = C

# ---- yours to set on the command line -------------------------------------------------------------------------------
CC         = cc
AR         = ar
CFLAGS     = -O2 -g
LDFLAGS    =
PKG_CONFIG = pkg-config
PREFIX     = /usr/local
DESTDIR    =
BUILD      = build
# compiler of the program that writes the tables, when CC makes code for another machine
HOSTCC     = $(CC)
# levels of code that takes longer to compile than to run
HOST_LEVEL =
TEST_LEVEL = -Og -g1
# extra warnings policy: make WERROR=-Werror
WERROR     =
# -DFIBRAD_TABLE_AZIMUTHS=256 and the like, kernel/sample/tables.h
TABLES     =
# position independent, so that the archive also goes into shared objects; empty for machines without an operating system
PIC        = -fPIC -fno-semantic-interposition
# number in the name of the shared library: another one when a function or structure of the public headers changes
ABI        = 3
# instruction sets of the laned sources: scalar, then any of sse2 avx2 avx512, or neon
MACHINE   := $(shell $(CC) -dumpmachine)
ISAS      := scalar $(if $(filter x86_64% i%86%,$(MACHINE)),sse2 avx2 avx512) $(if $(filter aarch64%,$(MACHINE)),neon)

# ---- what the sources need ------------------------------------------------------------------------------------------
WARNINGS = -pedantic -Wall -Wextra -Wconversion -Wshadow -Wvla $(WERROR)
COMMON   = -std=c11 -ffp-contract=off $(UNFUSED) $(WARNINGS) -Ikernel -MMD -MP
# gcc 12 fuses products and sums of vectors that it makes itself, in spite of -ffp-contract=off
UNFUSED := $(if $(shell $(CC) $(CFLAGS) -dM -E -xc /dev/null | grep -E '__(FMA4?|AVX512F)__'),-fno-tree-vectorize)
# tables of addresses would be data in position independent code; atomics out of line, a call of libgcc
KERNEL_FLAGS = $(COMMON) -ffreestanding -fno-math-errno -fno-trapping-math $(PIC) -fno-jump-tables $(TABLES) $(WITH_ISAS) \
               $(if $(filter aarch64%,$(MACHINE)),-mno-outline-atomics)
SIMPLE_FLAGS = $(COMMON) -D_XOPEN_SOURCE=700 -D_FILE_OFFSET_BITS=64 -Ihost -fopenmp -fno-math-errno -fno-trapping-math $(PIC)
HOST_FLAGS   = $(COMMON) -D_XOPEN_SOURCE=700 -fopenmp -Ihost $(GSL_CFLAGS) $(ZLIB_CFLAGS)
TEST_FLAGS   = $(HOST_FLAGS) $(CHECK_CFLAGS) $(TABLES) $(WITH_ISAS)

WITH_sse2   = -DFIBRAD_WITH_SSE2
WITH_avx2   = -DFIBRAD_WITH_AVX2
WITH_avx512 = -DFIBRAD_WITH_AVX512
WITH_neon   = -DFIBRAD_WITH_NEON
WITH_ISAS   = $(foreach isa,$(filter-out scalar,$(ISAS)),$(WITH_$(isa)))

# no -mfma, no contraction: products and sums round one by one in every instruction set. AVX-512 has fused operations.
FLAGS_scalar =
FLAGS_sse2   = -msse2
FLAGS_avx2   = -mavx2 -mpopcnt
FLAGS_avx512 = -mavx512f -mavx512dq -mavx512bw -mavx512vl -mpopcnt -fno-tree-vectorize
FLAGS_neon   =

# asked for when used, since `make deps` may just have installed them
GSL_CFLAGS   = $(shell $(PKG_CONFIG) --cflags gsl)
GSL_LIBS     = $(shell $(PKG_CONFIG) --libs gsl)
ZLIB_CFLAGS  = $(shell $(PKG_CONFIG) --cflags zlib)
ZLIB_LIBS    = $(shell $(PKG_CONFIG) --libs zlib)
CHECK_CFLAGS = $(shell $(PKG_CONFIG) --cflags check)
CHECK_LIBS   = $(shell $(PKG_CONFIG) --libs check)

# the public headers, and sed that finds their functions
HEADERS   = kernel/fibrad.h kernel/fibrad_limits.h kernel/fibrad_heat.h kernel/fibrad_light.h kernel/fibrad_mesh.h kernel/fibrad_surface.h kernel/fibrad_furnace.h host/simple/fibrad_host.h
FUNCTIONS = '/^typedef/d; s/^[a-z].*[ *]\(fibrad_[a-z0-9_]*\)(.*/\1;/p'

# ---- sources: what a folder holds belongs to it ---------------------------------------------------------------------
sources = $(sort $(wildcard $(1)))

LANED   := $(call sources,kernel/*/*_lanes.c) # compiled once per instruction set
KERNEL  := $(filter-out %_lanes.c,$(call sources,kernel/*/*.c))
SIMPLE  := $(call sources,host/simple/*.c) # libfibrad_host.a
HOST    := $(filter-out $(addprefix host/,simple/% couple/% python/% tables/%),$(call sources,host/*/*.c host/read/*/*.c host/papers/*/*.c)) # the program, besides main.c
TESTS   := $(call sources,tests/test_*.c)
SCRIPTS := $(filter-out tests/couple/% tests/freestanding/%,$(call sources,tests/check_*.sh tests/*/check_*.sh))
# other machines, and what takes long: `make nightly`
NIGHTLY := tests/check_dist.sh tests/package/check_deb.sh tests/check_tables.sh tests/couple/check_made.sh tests/couple/check_pages.sh tests/partner/check_openfoam.sh \
           tests/test_furnace.c tests/test_reproduce.c

PEERS   := $(call sources,bench/bench_embree*.c) # built and run where Embree 3 is found (Debian: libembree-dev)
COUNTED := bench/bench_instructions.c # linked with a library that counts its instructions, bench/count_cc.sh; on x86-64
BENCHES := $(filter-out $(PEERS) $(COUNTED),$(call sources,bench/bench_*.c))

# libfibrad_files.so, by which Python reads files as the program does: its own objects, since these have names of the program
FILES = host/python/file_arrays.c host/bed/bed.c host/bed/units.c $(filter host/cli/interrupt.c host/cli/memory.c host/cli/message.c host/cli/output.c host/cli/spelling.c \
    host/mesh/%.c host/text/%.c host/read/%.c,$(filter-out host/read/read_rows.c host/text/read_curve.c host/text/report.c,$(HOST)))

# ---- objects --------------------------------------------------------------------------------------------------------
PLAIN_OBJECTS  = $(KERNEL:%.c=$(BUILD)/%.o)
LANED_OBJECTS  = $(foreach isa,$(ISAS),$(LANED:%.c=$(BUILD)/%_$(isa).o))
KERNEL_OBJECTS = $(BUILD)/tables.o $(PLAIN_OBJECTS) $(LANED_OBJECTS)
SIMPLE_OBJECTS = $(SIMPLE:%.c=$(BUILD)/%.o)
HOST_OBJECTS   = $(HOST:%.c=$(BUILD)/%.o)
FILES_OBJECTS  = $(FILES:%.c=$(BUILD)/files/%.o)
SHARED         = $(BUILD)/libfibrad.so.$(ABI)
LIBRARIES      = $(BUILD)/libhost.a $(BUILD)/libfibrad_host.a $(BUILD)/libfibrad.a
TEST_PROGRAMS  = $(TESTS:%.c=$(BUILD)/%)
BENCH_PROGRAMS = $(BENCHES:%.c=$(BUILD)/%)
PEER_PROGRAMS  = $(PEERS:%.c=$(BUILD)/%)
COUNTING       = $(filter-out %/libfibrad.a,$(LIBRARIES)) $(BUILD)/counted/libfibrad.a
COUNT_PROGRAMS = $(COUNTED:%.c=$(BUILD)/%)
ALL_BENCHES    = $(BENCH_PROGRAMS) $(PEER_PROGRAMS) $(COUNT_PROGRAMS)

.PHONY: all lib lib-host lib-files dist demo reproduce test run-programs programs check symbols calls format house budget map structures bench bench-quick \
    bench-peers bench-counted skips stress bits golden mutate fuzz fuzz-programs fuzz-fixed sanitized threads clang-warnings lint cppcheck nightly deps deps-ci deps-nightly man install install-lib wheel deb clean help need-libraries need-check

## all: build/fibrad and the libraries (the default)
all: $(BUILD)/fibrad lib lib-host

## lib: build/libfibrad.a alone; needs only a C compiler
lib: $(BUILD)/libfibrad.a

## lib-host: build/libfibrad_host.a and libfibrad.so, which contains both libraries; needs OpenMP
lib-host: $(BUILD)/libfibrad_host.a $(BUILD)/libfibrad.so

$(BUILD)/libfibrad.a: $(KERNEL_OBJECTS)
	rm -f $@
	$(AR) rcs $@ $^

$(PLAIN_OBJECTS): $(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(KERNEL_FLAGS) -c $< -o $@

$(BUILD)/tables.o: $(BUILD)/tables.c
	$(CC) $(CFLAGS) $(KERNEL_FLAGS) -c $< -o $@

$(BUILD)/tables.c: $(BUILD)/generate_tables
	$< > $@

$(BUILD)/generate_tables: host/tables/generate_tables.c
	@mkdir -p $(@D)
	$(HOSTCC) -O2 $(COMMON) $< -lm -o $@

# writes kernel/sample/line_table.c anew, which takes minutes: build/generate_lines > kernel/sample/line_table.c
$(BUILD)/generate_lines: host/tables/generate_lines.c kernel/sample/direction.c $(BUILD)/tables.c
	$(HOSTCC) -O2 $(COMMON) $^ -lm -o $@

# $(1): instruction set. In the source, FIBRAD_LANES_HEADER is the header of its lane type and FIBRAD_ISA_SUFFIX ends
# the names of its external functions.
define laned_rule
$(LANED:%.c=$(BUILD)/%_$(1).o): $(BUILD)/%_$(1).o: %.c
	@mkdir -p $$(@D)
	$$(CC) $$(CFLAGS) $$(KERNEL_FLAGS) $$(FLAGS_$(1)) \
	    -DFIBRAD_LANES_HEADER='"base/lanes/vec_$(1).h"' -DFIBRAD_ISA_SUFFIX=_$(1) -c $$< -o $$@
endef
$(foreach isa,$(ISAS),$(eval $(call laned_rule,$(isa))))

$(BUILD)/libfibrad_host.a: $(SIMPLE_OBJECTS)
	rm -f $@
	$(AR) rcs $@ $^

$(SIMPLE_OBJECTS): $(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(HOST_LEVEL) $(SIMPLE_FLAGS) -c $< -o $@

# exports the functions of the public headers
$(BUILD)/fibrad.map: $(HEADERS) Makefile
	@mkdir -p $(@D)
	{ echo 'FIBRAD_$(ABI) { global:'; sed -n $(FUNCTIONS) $(HEADERS); echo 'local: *; };'; } > $@

$(SHARED): $(KERNEL_OBJECTS) $(SIMPLE_OBJECTS) $(BUILD)/fibrad.map
	$(CC) $(CFLAGS) $(LDFLAGS) -shared -fopenmp -Wl,-soname,$(@F) -Wl,--version-script=$(BUILD)/fibrad.map \
	    -Wl,-Bsymbolic -Wl,-z,defs $(KERNEL_OBJECTS) $(SIMPLE_OBJECTS) -o $@

$(BUILD)/libfibrad.so: $(SHARED)
	ln -sf $(<F) $@

$(BUILD)/fibrad: $(BUILD)/host/main.o $(LIBRARIES)
	$(CC) $(LDFLAGS) -fopenmp $^ $(GSL_LIBS) $(ZLIB_LIBS) -lm -o $@

## lib-files: libfibrad_files.so for fibrad.read and Mesh.from_stl of Python; needs zlib
lib-files: $(BUILD)/libfibrad_files.so

$(BUILD)/libfibrad_files.so: $(FILES_OBJECTS) $(BUILD)/libfibrad.a
	$(CC) $(CFLAGS) $(LDFLAGS) -shared -Wl,-Bsymbolic -Wl,-z,defs -Wl,--exclude-libs,ALL $^ $(ZLIB_LIBS) -lm -o $@

$(FILES_OBJECTS): $(BUILD)/files/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(COMMON) -D_XOPEN_SOURCE=700 -D_FILE_OFFSET_BITS=64 -Ihost $(ZLIB_CFLAGS) $(PIC) -fvisibility=hidden -c $< -o $@

# all of the host but main, for tests and benches to link
$(BUILD)/libhost.a: $(HOST_OBJECTS)
	rm -f $@
	$(AR) rcs $@ $^

$(BUILD)/host/main.o $(HOST_OBJECTS): $(BUILD)/%.o: %.c | need-libraries
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(HOST_LEVEL) $(HOST_FLAGS) -c $< -o $@

$(TEST_PROGRAMS): $(BUILD)/%: %.c $(LIBRARIES) | need-libraries need-check
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(TEST_LEVEL) $(TEST_FLAGS) $(LDFLAGS) $(WRAPPED) $< $(LIBRARIES) $(CHECK_LIBS) $(GSL_LIBS) $(ZLIB_LIBS) -lm -o $@

# stands in for libprecice
STAND_IN = $(BUILD)/tests/partner/libprecice.so.3
$(STAND_IN): tests/partner/precice.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) -fPIC -shared $(LDFLAGS) $< -lm -o $@
$(BUILD)/tests/test_couple: | $(STAND_IN)

# these follow many rays of their own
$(patsubst %,$(BUILD)/tests/test_%,clump_heat light_cones light_heat light_mesh light_spots solid trace walls): TEST_LEVEL = -O2

# this test counts calls of the kernel
$(BUILD)/tests/test_scenes: WRAPPED = -Wl,--wrap=fibrad_scene_init

$(BENCH_PROGRAMS): $(BUILD)/%: %.c $(LIBRARIES) | need-libraries
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(HOST_FLAGS) $(WITH_ISAS) $(LDFLAGS) $< $(LIBRARIES) $(GSL_LIBS) $(ZLIB_LIBS) -lm -o $@

$(PEER_PROGRAMS): $(BUILD)/%: %.c $(LIBRARIES) | need-libraries
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) -O3 $(HOST_FLAGS) $(LDFLAGS) $< $(LIBRARIES) -lembree3 $(GSL_LIBS) $(ZLIB_LIBS) -lm -o $@

$(COUNT_PROGRAMS): $(BUILD)/%: %.c $(COUNTING) | need-libraries
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(HOST_FLAGS) $(LDFLAGS) $< $(COUNTING) $(GSL_LIBS) $(ZLIB_LIBS) -lm -o $@

need-libraries:
	@$(PKG_CONFIG) --exists gsl zlib || { echo "The program fibrad needs GSL and zlib: run 'make deps' (Debian: pkg-config, libgsl-dev, zlib1g-dev)." \
	    "'make lib' builds libfibrad.a without it." >&2; exit 1; }

need-check:
	@$(PKG_CONFIG) --exists check || { echo "The tests need libcheck: run 'make deps' (Debian: check)." >&2; exit 1; }

# other flags, other objects (for flags on the command line: another BUILD)
$(KERNEL_OBJECTS) $(SIMPLE_OBJECTS) $(HOST_OBJECTS) $(FILES_OBJECTS) $(BUILD)/host/main.o $(TEST_PROGRAMS) $(ALL_BENCHES): Makefile

-include $(KERNEL_OBJECTS:.o=.d) $(SIMPLE_OBJECTS:.o=.d) $(FILES_OBJECTS:.o=.d) $(HOST_OBJECTS:.o=.d) $(TEST_PROGRAMS:=.d) $(ALL_BENCHES:=.d) $(BUILD)/host/main.d

include host/couple/couple.mk

# ---- what one does with them ----------------------------------------------------------------------------------------
DEMO_BED = tests/data/mono2000.dump

## demo: install missing packages, build, compute the view factors of a settled bed of 2,000 spheres, plot them
demo: deps
	@echo "Building $(BUILD)/fibrad"
	@$(MAKE) -s --no-print-directory $(BUILD)/fibrad
	@mkdir -p $(BUILD)/demo
	$(BUILD)/fibrad factors $(DEMO_BED) --plot $(BUILD)/demo/bed.png -o $(BUILD)/demo/F.mtx
	@echo
	@echo "The matrix of view factors: $(BUILD)/demo/F.mtx"
	@echo "The picture of the bed:     $(BUILD)/demo/bed.png"

## dist: build/dist/fibrad.c and fibrad.h, the whole kernel in two files for other build systems; all sources of the last commit as a .tar.gz
VERSION = $(shell sed -n 's/^\#define FIBRAD_VERSION "\(.*\)"/\1/p' kernel/fibrad.h)
dist: $(BUILD)/dist/fibrad.c
	git archive --prefix=fibrad-$(VERSION)/ -o $(BUILD)/dist/fibrad-$(VERSION).tar.gz HEAD

$(BUILD)/dist/fibrad.c: $(BUILD)/tables.c $(KERNEL) $(LANED) $(wildcard kernel/*.h kernel/*/*.h kernel/*/*/*.h) kernel/join.sh
	kernel/join.sh $(abspath $<) $(abspath $(@D)) $(KERNEL) $(LANED)

# what scripts of tests are told
WITH_MPI = BUILD=$(BUILD) CC="$(CC)" MAKE="$(MAKE)" MPICC="$(MPICC)" MPIRUN="$(MPIRUN)"

## test: install missing packages, build and run all tests but those of nightly
test: deps
	@echo "Building the tests"
	@$(MAKE) -s --no-print-directory programs all man $(BUILD)/dist/fibrad.c
	@$(WITH_MPI) tests/run.sh $(filter-out $(NIGHTLY) $(NIGHTLY:%.c=$(BUILD)/%),$(COUPLE_SCRIPTS) $(SCRIPTS) $(TEST_PROGRAMS))

## test-ROOM: build and run the tests of one room, in seconds: test-heat, test-mesh, test-read ...; tests/rooms.txt has all
ROOMS   = $(shell sed -n 's/^\([a-z]*\) .*/\1/p' tests/rooms.txt)
of_room = $(shell sed -n 's/^$(1) //p' tests/rooms.txt)
scripts_of  = $(addprefix tests/,$(filter %.sh,$(call of_room,$(1))))
programs_of = $(patsubst %.c,$(BUILD)/%,$(wildcard $(patsubst %,tests/test_%.c,$(filter-out %.sh,$(call of_room,$(1))))))
test-%:
	@test -n "$(call of_room,$*)" || { echo "There is no room $*. The rooms are $(ROOMS)." >&2; exit 1; }
	@$(MAKE) -s --no-print-directory $(BUILD)/fibrad $(call programs_of,$*) $(if $(call scripts_of,$*),all man)
	@$(WITH_MPI) tests/run.sh $(call scripts_of,$*) $(call programs_of,$*)

## run-programs: build and run the test programs without the scripts
run-programs: programs
	@BUILD=$(BUILD) tests/run.sh $(TEST_PROGRAMS)

## programs: build the test programs
programs: $(TEST_PROGRAMS) $(BUILD)/fibrad

## check: the symbols of libfibrad.a, calls among files, the format of the sources, and the house
check: symbols calls format house

## map: folders of kernel and host and what they are for; ROOM=heat: the files of one folder
ROOM =
map:
	@python3 tests/rooms.py map $(ROOM)

## budget: write today's code lines of folders and words of pages into tests/budget.txt
budget:
	python3 tests/rooms.py write

## house: circles of folders and files, links of pages, tests/budget.txt, and what `make structures` writes
house:
	tests/check_house.sh
	python3 tests/rooms.py check
	python3 host/python/write_structures.py --check $(HEADERS)

## structures: what Python and Fortran need of the public headers, after a change of these
structures:
	python3 host/python/write_structures.py $(HEADERS)

## calls: no circle of calls among files of the libraries and the program
calls: lib lib-host $(BUILD)/libhost.a
	BUILD=$(BUILD) tests/check_calls.sh

## symbols: libfibrad.a defines only fibrad_*, needs only memory copying and has no variables; what other libraries export
symbols: lib lib-host
	BUILD=$(BUILD) tests/check_symbols.sh

FORMATTED = $(wildcard kernel/*.h kernel/*/*.[ch] kernel/*/*/*.h host/*.c host/*/*.[ch] host/*/*/*.[ch] host/*/*/*.cpp host/couple/lammps/debian/fmt/*.h tests/*.[ch] tests/*/*.[ch] tests/*/*.cpp bench/*.[ch] docs/examples/*.c docs/examples/*.cpp docs/examples/*/*.c)

## format: every source has the format of .clang-format (to repair: clang-format -i FILE)
format:
	printf '%s\n' $(FORMATTED) | xargs -P 2 -n 60 clang-format --dry-run --Werror

BENCH_ENV = BENCH_COMMIT="$$(git describe --always --dirty 2>/dev/null)" BENCH_FLAGS="$(CFLAGS) -ffp-contract=off"

# these end with the processor time that they took; programs are built before
TIMED = bench bench-quick skips stress mutate reproduce
.PHONY: $(TIMED:%=run-%)
$(TIMED):
	@bash -c 'TIMEFORMAT="make $@: processor time %U s, system %S s"; time "$$0" "$$@"' $(MAKE) -s --no-print-directory run-$@

## bench: build and run all benches; CSV into build/bench, plots into docs/figures
bench bench-quick: $(BENCH_PROGRAMS) bench-peers bench-counted
# those with threads of their own alone, two of the others at a time: most figures are processor times
BENCHES_ALONE = $(filter %_furnace %_scale,$(ALL_BENCHES))
one_bench     = sh -ec 'test -x {} || exit 0; echo "{} > {}.csv"; $(BENCH_ENV) {} > {}.csv'
run-bench:
	@printf '%s\n' $(BENCHES_ALONE) | xargs -I{} $(one_bench)
	@printf '%s\n' $(filter-out $(BENCHES_ALONE),$(ALL_BENCHES)) | xargs -P 2 -I{} $(one_bench)
	gnuplot -e "in='$(BUILD)/bench/bench_beam.csv'; peer='$(BUILD)/bench/bench_embree.csv'; \
	    out='docs/figures/beam_error.svg'" bench/plot_beam.gp
	gnuplot -e "in='$(BUILD)/bench/bench_scale.csv'; out='$(BUILD)/bench/scale.svg'" bench/plot_scale.gp

## bench-quick: build all benches and run the smallest case of each, to see that they work
run-bench-quick:
	@set -e; mkdir -p $(BUILD)/bench/quick; for b in $(notdir $(ALL_BENCHES)); do \
	    test -x $(BUILD)/bench/$$b || continue; echo "$$b quick"; \
	    $(BENCH_ENV) $(BUILD)/bench/$$b quick > $(BUILD)/bench/quick/$$b.csv; done
	gnuplot -e "in='$(BUILD)/bench/quick/bench_beam.csv'; peer='$(BUILD)/bench/quick/bench_embree.csv'; \
	    out='$(BUILD)/bench/quick/beam_error.svg'" bench/plot_beam.gp
	gnuplot -e "in='$(BUILD)/bench/quick/bench_scale.csv'; out='$(BUILD)/bench/quick/scale.svg'" bench/plot_scale.gp

# asks the compiler, so any place it looks in will do
bench-peers:
	@if echo '#include <embree3/rtcore.h>' | $(CC) -E -xc - >/dev/null 2>&1; then \
	    $(MAKE) -s --no-print-directory $(PEER_PROGRAMS); \
	else echo "No Embree 3 (Debian: libembree-dev): its benches are skipped"; fi

# the library is made anew where its sources have changed: its own make knows
bench-counted: $(filter-out %/libfibrad.a,$(LIBRARIES))
	@case $$($(CC) -dumpmachine) in x86_64*|aarch64*) \
	    $(MAKE) -s --no-print-directory BUILD=$(BUILD)/counted CC="bench/count_cc.sh $(CC)" HOSTCC="$(HOSTCC)" lib && \
	    $(MAKE) -s --no-print-directory $(COUNT_PROGRAMS) ;; \
	*) echo "Instructions are only counted on x86-64 and aarch64" ;; esac

## skips: time that skipped steps save; each skip without an argument is turned off in a copy of the kernel (some minutes)
run-skips:
	BUILD=$(BUILD) MAKE="$(MAKE)" CC="$(CC)" bench/skips.sh

## stress: attacks on the numerics, one line for each attack (some minutes)
stress: $(BUILD)/tests/test_stress $(BUILD)/tests/test_areas
run-stress:
	STRESS=1 CK_DEFAULT_TIMEOUT=3600 $(BUILD)/tests/test_stress
	$(BUILD)/tests/test_areas

## bits: compare bits with the pinned ones for all compilers, levels, instruction sets and processors (some minutes)
bits: $(BUILD)/fibrad
	BUILD=$(BUILD) MAKE="$(MAKE)" tests/check_bits.sh all

## golden: pin the present bits, after a deliberate change of results
golden: $(BUILD)/fibrad
	BUILD=$(BUILD) MAKE="$(MAKE)" HOSTCC="$(HOSTCC)" tests/check_bits.sh pin

## mutate: break the kernel in one line after the other and see that the tests notice (some minutes)
run-mutate:
	BUILD=$(BUILD) MAKE="$(MAKE)" CC="$(CC)" tests/mutate.sh

# One build under the sanitizers serves the fuzzers and the tests: of scalar code and of the widest lanes that run here.
SANITIZE  = address,undefined
SANITIZED_ISAS = scalar $(if $(shell grep -m 1 avx512dq /proc/cpuinfo),avx512,$(lastword $(filter-out scalar avx512,$(ISAS))))
ALL_ISAS  = BUILD=$(BUILD)/nightly SANITIZED_ISAS="$(ISAS)"
SANITIZED = $(MAKE) -s --no-print-directory BUILD=$(BUILD)/sanitized ISAS="$(SANITIZED_ISAS)" CC=clang LDFLAGS=-fsanitize=$(SANITIZE) \
            CFLAGS="-O1 -g -fsanitize=fuzzer-no-link,$(SANITIZE) -fno-sanitize-recover=undefined" HOST_LEVEL=-O0 TEST_LEVEL="-O1 -g1"

## sanitized: tests of memory, protocols and readers under the address and undefined behaviour sanitizers
OF_MEMORY = bed_make curve heat_arguments matrix_calls protocol protocol_heat read read_furnace scene status work write
sanitized:
	+@LSAN_OPTIONS=suppressions=tests/leaks.txt:print_suppressions=0 CK_FORK=no \
	    $(SANITIZED) TESTS="$(OF_MEMORY:%=tests/test_%.c)" run-programs

# Inputs found on the way are kept; of a crash, the input that caused it. The time limit of one input is for what would
# never end: machines are slow and sanitizers slower.
FUZZ         = $(BUILD)/sanitized/fuzz
FUZZ_SECONDS = 60
FUZZ_TARGETS = read kernel host
FUZZ_FLAGS   = -timeout=60 -rss_limit_mb=4096 -malloc_limit_mb=64 -close_fd_mask=2 -print_final_stats=1

fuzz-programs: need-libraries
	+@$(SANITIZED) $(LIBRARIES:$(BUILD)/%=$(BUILD)/sanitized/%)
	@mkdir -p $(FUZZ)
	@printf '%s\n' $(FUZZ_TARGETS) | xargs -P 2 -I{} clang -O1 -g -fsanitize=fuzzer,$(SANITIZE) -fno-sanitize-recover=undefined \
	    $(HOST_FLAGS) tests/fuzz/fuzz_{}.c $(LIBRARIES:$(BUILD)/%=$(BUILD)/sanitized/%) $(GSL_LIBS) $(ZLIB_LIBS) -lm -o $(FUZZ)/fuzz_{}

## fuzz: hostile input for the readers, the kernel and the simple layer, FUZZ_SECONDS=60 in all
fuzz: fuzz-programs
	@set -e; for target in $(FUZZ_TARGETS); do \
	    mkdir -p $(FUZZ)/found_$$target; \
	    $(FUZZ)/fuzz_$$target $(FUZZ_FLAGS) -max_total_time=$$(($(FUZZ_SECONDS) / 3)) \
	        -artifact_prefix=$(FUZZ)/$$target- $(FUZZ)/found_$$target tests/fuzz/corpus_$$target; \
	done

## fuzz-fixed: fuzz with a fixed number of inputs, the same ones every time (quarter of a minute)
FUZZ_RUNS = kernel:250 host:60 read:3000
# what comparisons show would bring addresses in, which differ from run to run: -use_cmp=0
fuzz-fixed: fuzz-programs
	@echo $(FUZZ_RUNS) | tr ' ' '\n' | OMP_WAIT_POLICY=passive xargs -P 2 -I{} sh -ec 'run={}; target=$${run%:*}; \
	    rm -rf $(FUZZ)/fixed_$$target; mkdir -p $(FUZZ)/fixed_$$target; \
	    if $(FUZZ)/fuzz_$$target $(FUZZ_FLAGS) -seed=1 -use_cmp=0 -runs=$${run#*:} -artifact_prefix=$(FUZZ)/$$target- \
	        $(FUZZ)/fixed_$$target tests/fuzz/corpus_$$target >$(FUZZ)/$$target.log 2>&1; \
	    then grep -h "^Done\|calls" $(FUZZ)/$$target.log; else tail -n 60 $(FUZZ)/$$target.log; exit 1; fi'

## threads: the program under the thread sanitizer, with clang's OpenMP, whose barriers the sanitizer knows
threads:
	@$(MAKE) -s --no-print-directory BUILD=$(BUILD)/threads CC=clang CFLAGS="-O1 -g -fsanitize=thread" \
	    LDFLAGS=-fsanitize=thread $(BUILD)/threads/fibrad
	for t in 2 7; do \
	    TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1" OMP_TOOL_LIBRARIES=libarcher.so \
	    $(BUILD)/threads/fibrad factors $(DEMO_BED) --directions 21 --threads $$t -o $(BUILD)/threads/F.mtx || exit 1; \
	done

# $(1): flags, $(2): sources
clang_warns = printf '%s\n' $(2) | xargs -P 2 -n 10 clang -fsyntax-only $(filter-out -MMD -MP,$(1)) -Werror

## clang-warnings: clang reads all sources for every instruction set, without making code; its warnings are errors
clang-warnings: need-libraries need-check
	$(call clang_warns,$(KERNEL_FLAGS),$(KERNEL))
	$(foreach isa,$(ISAS),$(call clang_warns,$(KERNEL_FLAGS) $(FLAGS_$(isa)) \
	    -DFIBRAD_LANES_HEADER='"base/lanes/vec_$(isa).h"' -DFIBRAD_ISA_SUFFIX=_$(isa),$(LANED)) &&) true
	$(call clang_warns,$(SIMPLE_FLAGS),$(SIMPLE))
	$(call clang_warns,$(TEST_FLAGS),$(HOST) host/main.c $(TESTS) $(BENCHES) $(COUNTED))

LINT_FLAGS   = -Ikernel -Ihost -D_XOPEN_SOURCE=700
LINT_SCALAR  = -DFIBRAD_LANES_HEADER='"base/lanes/vec_scalar.h"' -DFIBRAD_ISA_SUFFIX=_scalar

## lint: cppcheck and clang-tidy; .cppcheck and .clang-tidy have the exceptions and their reasons
lint: cppcheck
	printf '%s\n' $(KERNEL) $(LANED) | xargs -I{} -P 2 clang-tidy --quiet {} -- -std=c11 $(LINT_FLAGS) $(LINT_SCALAR)
	printf '%s\n' $(SIMPLE) $(HOST) host/main.c $(wildcard host/tables/generate_*.c) | xargs -I{} -P 2 \
	    clang-tidy --quiet --checks=-clang-analyzer-core.* {} -- -std=c11 -fopenmp $(LINT_FLAGS)
	@if command -v $(MPICC) >/dev/null; then printf '%s\n' $(COUPLE) $(COUPLE_WALLS) $(COUPLE_PROGRAMS) | xargs -I{} -P 2 \
	    clang-tidy --quiet --checks=-clang-analyzer-core.*,-clang-analyzer-optin.mpi.* {} -- -std=c11 -fopenmp \
	    $(LINT_FLAGS) $$($(MPICC) -show | tr ' ' '\n' | grep '^-I'); \
	else echo "No MPI: couplings are not checked"; fi

cppcheck:
	cppcheck --quiet -j 2 --std=c11 --error-exitcode=1 --enable=warning,portability,performance \
	    --suppress=missingIncludeSystem --suppressions-list=.cppcheck $(LINT_FLAGS) $(LINT_SCALAR) kernel host

## nightly: what .ci/run leaves out: other compilers and machines, static checks, all of the couplings, long fuzzing
nightly: deps-nightly bits threads lint clang-warnings bench-quick skips stress programs couple
	$(MAKE) reproduce FIGURES=$(BUILD)/figures
	for csv in $(filter-out %/table1.csv,$(wildcard docs/figures/*.csv)); do diff -I ^table1, $$csv $(BUILD)/figures || exit 1; done
	BUILD=$(BUILD) MAKE="$(MAKE)" tests/check_dist.sh all
	BUILD=$(BUILD) MAKE="$(MAKE)" CC="$(CC)" tests/package/check_deb.sh
	BUILD=$(BUILD) tests/check_tables.sh all
	BUILD=$(BUILD) tests/partner/check_openfoam.sh
	BUILD=$(BUILD) CC="$(CC)" tests/check_python.sh
	BUILD=$(BUILD) MAKE="$(MAKE)" CC="$(CC)" HOSTCC="$(HOSTCC)" tests/freestanding/check_freestanding.sh
	BUILD=$(BUILD) NIGHTLY=1 tests/run.sh tests/check_readme.sh $(TEST_PROGRAMS)
	$(MAKE) test-couple
	$(MAKE) mutate
	$(MAKE) sanitized $(ALL_ISAS) OF_MEMORY="$(filter-out accuracy furnace reference reproduce,$(TESTS:tests/test_%.c=%))"
	$(MAKE) fuzz-fixed $(ALL_ISAS) FUZZ_RUNS="read:40000 kernel:2000 host:300"
	$(MAKE) fuzz $(ALL_ISAS) FUZZ_SECONDS=900

## reproduce: the numbers of the papers beside ours, and their plots into docs/figures
FIGURES   = docs/figures
reproduce: $(BUILD)/fibrad
run-reproduce:
	$(BUILD)/fibrad reproduce -o $(FIGURES)
	gnuplot -e "folder='$(FIGURES)'" bench/plot_papers.gp

# installs the named Debian packages that are missing
DEPS = .ci/deps

## deps: install the Debian packages that build, demo and tests need; does nothing when nothing is missing
deps:
	@$(DEPS) libc6-dev pkg-config libgsl-dev zlib1g-dev check gnuplot-nox

## deps-ci: install the further packages that .ci/run needs
deps-ci:
	@$(DEPS) g++ clang clang-format libomp-dev libclang-rt-14-dev shellcheck python3-numpy python3-scipy python3-pytest \
	    python3-venv python3-pip gfortran

## deps-nightly: install the further packages that nightly needs
deps-nightly: deps deps-ci deps-couple
	@$(DEPS) clang-tidy cppcheck gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user gcc-arm-none-eabi qemu-system-arm \
	    cmake dpkg-dev lintian yade openfoam

## man: manual pages of the program and its commands, made from --help into build/man
man: $(BUILD)/man/fibrad.1

$(BUILD)/man/fibrad.1: $(BUILD)/fibrad host/cli/man/make_man.sh host/cli/man/man.awk
	host/cli/man/make_man.sh $< $(@D)

COMPLETIONS = $(DESTDIR)$(PREFIX)/share/bash-completion/completions

## install: the program, its manual pages and completion, documents, libraries, headers and .pc files, to DESTDIR and PREFIX
install: install-lib $(BUILD)/fibrad man
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/share/man/man1 $(COMPLETIONS) \
	    $(DESTDIR)$(PREFIX)/share/doc/fibrad/docs/figures
	install $(BUILD)/fibrad $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(BUILD)/man/*.1 $(DESTDIR)$(PREFIX)/share/man/man1
	install -m 644 host/cli/man/fibrad.bash $(COMPLETIONS)/fibrad
	install -m 644 README.md CHANGELOG.md LICENSE CITATION.cff SECURITY.md $(DESTDIR)$(PREFIX)/share/doc/fibrad
	install -m 644 docs/*.md $(DESTDIR)$(PREFIX)/share/doc/fibrad/docs
	install -m 644 docs/figures/* $(DESTDIR)$(PREFIX)/share/doc/fibrad/docs/figures
	cp -r docs/examples $(DESTDIR)$(PREFIX)/share/doc/fibrad/docs

PC_FILES = kernel/fibrad.pc.in host/simple/fibrad_host.pc.in

# installs files for pkg-config
install_pc = for pc in $(1:.in=); do sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(VERSION)|' $$pc.in \
	        > $(DESTDIR)$(PREFIX)/lib/pkgconfig/$${pc\#\#*/} || exit 1; done

## install-lib: install without the program
install-lib: lib lib-host
	install -d $(DESTDIR)$(PREFIX)/include $(DESTDIR)$(PREFIX)/lib/pkgconfig
	install -m 644 $(HEADERS) $(DESTDIR)$(PREFIX)/include
	install -m 644 $(BUILD)/libfibrad.a $(BUILD)/libfibrad_host.a $(SHARED) $(DESTDIR)$(PREFIX)/lib
	ln -sf $(notdir $(SHARED)) $(DESTDIR)$(PREFIX)/lib/libfibrad.so
	$(call install_pc,$(PC_FILES))
	install -d $(DESTDIR)$(PREFIX)/lib/cmake/fibrad
	for part in fibradConfig fibradConfigVersion; do sed 's|@VERSION@|$(VERSION)|' host/packaging/$$part.cmake.in \
	    > $(DESTDIR)$(PREFIX)/lib/cmake/fibrad/$$part.cmake || exit 1; done

## wheel: build/wheel/fibrad-*.whl, the Python package for any Python from 3.9
wheel: lib-host lib-files
	rm -rf $(BUILD)/wheel && mkdir -p $(BUILD)/wheel
	BUILD=$(abspath $(BUILD)) CC="$(CC)" /usr/bin/python3 -B -c "import sys; sys.path.insert(0, 'host/python/build_backend'); \
	    import fibrad_build; print('$(BUILD)/wheel/' + fibrad_build.build_wheel('$(BUILD)/wheel'))"

## deb: build/deb/*.deb, packages of the program, the libraries and Python for Debian
deb: $(BUILD)/fibrad
	BUILD=$(abspath $(BUILD)) MAKE="$(MAKE)" CC="$(CC)" host/packaging/make_deb.sh $(BUILD)/deb

## clean: remove all that was built
clean:
	rm -rf $(BUILD)

## help: this list
help:
	@sed -n 's/^## \([^:]*\): /  \1\t/p' Makefile $(wildcard host/*/*.mk host/*/*/*.mk) | expand -t 16
	@echo "  Rooms of test-ROOM: $(ROOMS)" | fold -s -w 118
	@echo "  Settable: CC AR CFLAGS LDFLAGS PREFIX DESTDIR BUILD ISAS TABLES PIC WERROR"
