# mpi.sh - how tests start ranks; read by other scripts. SPDX-License-Identifier: MIT
# shellcheck shell=sh

# Containers: more ranks than processors, as root, and without the copying between processes that they forbid.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1
export OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}"

run_mpi() { # RANKS PROGRAM...
    ranks_run=$1
    shift
    "${MPIRUN:-mpirun}" -np "$ranks_run" "$@" 2>&1
}

# limited_mpi RANKS PROGRAM...: ends with the status 152 if a rank takes more than 120 s of processor, so that a loaded machine
# is no failure. Ranks that wait for each other take processor time, too.
limited_mpi() {
    ranks_run=$1
    shift
    # shellcheck disable=SC3045  # every sh of Debian has it
    (ulimit -S -t 120 && exec "${MPIRUN:-mpirun}" -np "$ranks_run" "$@")
}

# Scripts that run at once have parts in common.
make_one_by_one() {
    flock "$BUILD/couple.lock" "${MAKE:-make}" -s --no-print-directory "$@"
}
