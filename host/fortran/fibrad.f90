! fibrad.f90 - view factors and thermal radiation of packed beds, in Fortran 2008, over libfibrad.so (fibrad_host.h).
!
! Index    fibrad_plane, fibrad_cylinder                     walls
!          fibrad_view_factors, fibrad_exchange_factors      matrices of factors
!          fibrad_heat: new, move, solve, free               net powers, step after step
!          fibrad_status_text, fibrad_version, fibrad_layouts_agree
!
! Arguments  Centres are three arrays x, y, z, radii one, all of one length; for positions (n, 3) pass at(:, 1), at(:, 2),
!            at(:, 3), which are not copied. Spheres, rows and columns count from 1. box has the lengths of the periodic
!            box, 0 along open axes; without it, or without walls, all is open.
! Units      One length unit for factors; metres, kelvins and watts for powers, which are positive where heat is gained.
! Errors     status is 0 or one of fibrad_e_*, fault the one or two spheres concerned, 0 where there are none; after an
!            error other results are not set. What an argument may be: fibrad.h, by the names of the C functions.
!
! SPDX-License-Identifier: MIT
module fibrad
    use, intrinsic :: iso_c_binding
    implicit none
    private
    public :: fibrad_plane, fibrad_cylinder, fibrad_view_factors, fibrad_exchange_factors
    public :: fibrad_status_text, fibrad_version, fibrad_layouts_agree

    integer, parameter, public :: fibrad_ok = 0, fibrad_e_argument = -1, fibrad_e_geometry = -6, fibrad_e_state = -8, &
                                  fibrad_e_unsupported = -10, fibrad_e_memory = -11
    real(c_double), parameter, public :: fibrad_stefan_boltzmann = 5.670374419e-8_c_double

    ! ---- structures of C, as in the headers
    type, bind(C) :: c_spheres
        type(c_ptr) :: x = c_null_ptr, y = c_null_ptr, z = c_null_ptr, r = c_null_ptr
        integer(c_int32_t) :: n = 0, stride = 0, stride_r = 0
        type(c_ptr) :: id = c_null_ptr
    end type c_spheres

    type, bind(C) :: c_plane
        integer(c_int) :: axis = 0, upper = 0
        real(c_double) :: at = 0
    end type c_plane

    type, bind(C) :: c_cylinder
        real(c_double) :: x = 0, y = 0, radius = 0
    end type c_cylinder

    ! A wall, by fibrad_plane or fibrad_cylinder.
    type, bind(C), public :: fibrad_wall
        integer(c_int) :: kind = 0
        type(c_plane) :: plane
        type(c_cylinder) :: cylinder
    end type fibrad_wall

    type, bind(C) :: c_scene_config
        integer(c_int) :: isa = 0
        real(c_double) :: period(3) = 0
        type(c_ptr) :: body = c_null_ptr
        integer(c_int32_t) :: bodies = 0
        real(c_double) :: known_low(3) = 0, known_high(3) = 0
        type(c_ptr) :: occupancy = c_null_ptr
    end type c_scene_config

    type, bind(C) :: c_fault
        integer(c_int32_t) :: first = 0, second = 0
    end type c_fault

    type, bind(C) :: c_scene_facts
        integer(c_int32_t) :: spheres = 0, bodies = 0
        integer(c_int) :: isa = 0
        integer(c_int32_t) :: cells = 0
        real(c_double) :: radius_min = 0, radius_max = 0, overlap_max = 0
        integer(c_int32_t) :: overlap_pair(2) = 0
    end type c_scene_facts

    type, bind(C) :: c_run
        integer(c_int) :: threads = 0
        type(c_funptr) :: progress = c_null_funptr
        type(c_ptr) :: context = c_null_ptr
        type(c_fault) :: fault
    end type c_run

    type, bind(C) :: c_beam_rule
        integer(c_int32_t) :: directions = 0, points = 0
        real(c_double) :: cutoff = 0, tolerance = 0
        integer(c_int64_t) :: turn = 0
    end type c_beam_rule

    type, bind(C) :: c_bed_options
        type(c_ptr) :: beam = c_null_ptr, surface = c_null_ptr, cast = c_null_ptr, wanted = c_null_ptr
        integer(c_int) :: raw = 0
        real(c_double) :: drop = 0
        integer(c_int) :: bodies = 1
        type(c_ptr) :: scratch = c_null_ptr
    end type c_bed_options

    type, bind(C) :: c_factors
        integer(c_int32_t) :: n = 0, bodies = 0
        type(c_ptr) :: start = c_null_ptr, col = c_null_ptr, f = c_null_ptr
        type(c_ptr) :: escaped = c_null_ptr, beyond = c_null_ptr, error = c_null_ptr, body = c_null_ptr
        type(c_ptr) :: body_body = c_null_ptr, body_escaped = c_null_ptr, body_error = c_null_ptr
        real(c_double) :: body_correction = 0
    end type c_factors

    type, bind(C) :: c_bed_factors
        type(c_factors) :: matrix
        type(c_scene_facts) :: facts
        type(c_ptr) :: body_area = c_null_ptr
        integer(c_int) :: threads = 0
        integer(c_int32_t) :: directions = 0
        integer(c_int64_t) :: fallbacks = 0, rays = 0
        real(c_double) :: seconds = 0, closure_error = 0, reciprocity_error = 0
    end type c_bed_factors

    type, bind(C) :: c_exchange_rule
        type(c_ptr) :: emissivity = c_null_ptr, body_emissivity = c_null_ptr
        integer(c_int32_t) :: directions = 0, paths = 0
        integer(c_int64_t) :: seed = 0
        real(c_double) :: cutoff = 0, tolerance = 0
    end type c_exchange_rule

    type, bind(C) :: c_heat_config
        integer(c_int32_t) :: directions = 0, points = 0, patches = 0, parts = 0
        real(c_double) :: cutoff = 0
        integer(c_int32_t) :: wall_rays = 0
    end type c_heat_config

    type, bind(C) :: c_heat_sources
        type(c_ptr) :: temperature = c_null_ptr, emissivity = c_null_ptr
        type(c_ptr) :: power = c_null_ptr, hold = c_null_ptr, reference = c_null_ptr
        type(c_ptr) :: body_temperature = c_null_ptr, body_emissivity = c_null_ptr, body_power = c_null_ptr
        type(c_ptr) :: insulated = c_null_ptr
        real(c_double) :: surroundings = 0, sigma = fibrad_stefan_boltzmann, tolerance = 0
        integer(c_int32_t) :: sweeps_max = 0
        integer(c_int) :: uniform = 0
    end type c_heat_sources

    type, bind(C) :: c_heat_result
        type(c_ptr) :: power = c_null_ptr, body_power = c_null_ptr
        real(c_double) :: surroundings_power = 0
        type(c_ptr) :: temperature = c_null_ptr, body_temperature = c_null_ptr
        type(c_ptr) :: power_error = c_null_ptr, body_error = c_null_ptr
        type(c_ptr) :: temperature_error = c_null_ptr, body_temperature_error = c_null_ptr
        real(c_double) :: error_patches = 0, error_beams = 0, residual = 0
        integer(c_int32_t) :: sweeps = 0
        type(c_ptr) :: body_absorbed = c_null_ptr
    end type c_heat_result

    interface
        function c_status_text(status) bind(C, name="fibrad_status_text")
            import :: c_int, c_ptr
            integer(c_int), value :: status
            type(c_ptr) :: c_status_text
        end function c_status_text

        function c_version() bind(C, name="fibrad_version")
            import :: c_ptr
            type(c_ptr) :: c_version
        end function c_version

        function c_sizeof_name(name) bind(C, name="fibrad_host_sizeof")
            import :: c_char, c_size_t
            character(kind=c_char), intent(in) :: name(*)
            integer(c_size_t) :: c_sizeof_name
        end function c_sizeof_name

        function c_view_factors(config, spheres, options, run, factors) bind(C, name="fibrad_view_factors")
            import :: c_int, c_ptr, c_scene_config, c_spheres, c_bed_options, c_run
            type(c_scene_config), intent(in) :: config
            type(c_spheres), intent(in) :: spheres
            type(c_bed_options), intent(in) :: options
            type(c_run), intent(inout) :: run
            type(c_ptr), intent(out) :: factors
            integer(c_int) :: c_view_factors
        end function c_view_factors

        function c_exchange_factors(config, spheres, rule, options, run, factors) bind(C, name="fibrad_exchange_factors")
            import :: c_int, c_ptr, c_scene_config, c_spheres, c_exchange_rule, c_bed_options, c_run
            type(c_scene_config), intent(in) :: config
            type(c_spheres), intent(in) :: spheres
            type(c_exchange_rule), intent(in) :: rule
            type(c_bed_options), intent(in) :: options
            type(c_run), intent(inout) :: run
            type(c_ptr), intent(out) :: factors
            integer(c_int) :: c_exchange_factors
        end function c_exchange_factors

        subroutine c_bed_free(factors) bind(C, name="fibrad_bed_free")
            import :: c_ptr
            type(c_ptr), value :: factors
        end subroutine c_bed_free

        function c_radiation_new(radiation, config, spheres, heat_config, run) bind(C, name="fibrad_radiation_new")
            import :: c_int, c_ptr, c_scene_config, c_spheres, c_heat_config, c_run
            type(c_ptr), intent(out) :: radiation
            type(c_scene_config), intent(in) :: config
            type(c_spheres), intent(in) :: spheres
            type(c_heat_config), intent(in) :: heat_config
            type(c_run), intent(inout) :: run
            integer(c_int) :: c_radiation_new
        end function c_radiation_new

        function c_radiation_move(radiation, config, spheres) bind(C, name="fibrad_radiation_move")
            import :: c_int, c_ptr, c_scene_config, c_spheres
            type(c_ptr), value :: radiation
            type(c_scene_config), intent(in) :: config
            type(c_spheres), intent(in) :: spheres
            integer(c_int) :: c_radiation_move
        end function c_radiation_move

        function c_radiation_solve(radiation, sources, result) bind(C, name="fibrad_radiation_solve")
            import :: c_int, c_ptr, c_heat_sources, c_heat_result
            type(c_ptr), value :: radiation
            type(c_heat_sources), intent(in) :: sources
            type(c_heat_result), intent(inout) :: result
            integer(c_int) :: c_radiation_solve
        end function c_radiation_solve

        subroutine c_radiation_describe(radiation, facts, fault) bind(C, name="fibrad_radiation_describe")
            import :: c_ptr, c_fault
            type(c_ptr), value :: radiation, facts
            type(c_fault), intent(inout) :: fault
        end subroutine c_radiation_describe

        subroutine c_radiation_free(radiation) bind(C, name="fibrad_radiation_free")
            import :: c_ptr
            type(c_ptr), value :: radiation
        end subroutine c_radiation_free
    end interface

    ! ---- results
    ! A matrix of factors in compressed rows. For each i the f of row i + wall(:, i) + escaped(i) + beyond(i) add up to 1.
    type, public :: fibrad_factors
        integer(c_int64_t), allocatable :: start(:) ! (n + 1): row i is start(i) to start(i + 1) - 1
        integer(c_int32_t), allocatable :: col(:)   ! (start(n + 1) - 1) the spheres that receive, ascending in a row
        real(c_double), allocatable :: f(:)         ! (start(n + 1) - 1) factor from the sphere of the row to col
        real(c_double), allocatable :: escaped(:)   ! (n) to the surroundings
        real(c_double), allocatable :: beyond(:)    ! (n) beyond the cutoff
        real(c_double), allocatable :: error(:)     ! (n) Euclidean error of each row, estimated
        real(c_double), allocatable :: wall(:, :)   ! (walls, n)
        real(c_double), allocatable :: wall_area(:) ! (walls)
        ! between walls: (j, i) from wall i to wall j, NaN from those without bounds; not allocated with a cutoff
        real(c_double), allocatable :: wall_wall(:, :)
        real(c_double), allocatable :: wall_escaped(:) ! (walls) from walls to the surroundings
        real(c_double), allocatable :: wall_error(:)   ! (walls) Euclidean error of these two, estimated
        integer :: directions = 0, threads = 0
        real(c_double) :: seconds = 0, closure_error = 0, reciprocity_error = 0
    end type fibrad_factors

    ! Radiation in a bed, step after step. Not to be copied: free gives back what it has.
    type, public :: fibrad_heat
        private
        type(c_ptr) :: radiation = c_null_ptr
        integer :: spheres = 0, walls = 0
    contains
        procedure, public :: new => heat_new
        procedure, public :: move => heat_move
        procedure, public :: solve => heat_solve
        procedure, public :: free => heat_free
    end type fibrad_heat

contains

    ! The wall called 'xmin', 'xmax' ... 'zmax' at a place on its axis; of another name: refused by what it is passed to.
    pure function fibrad_plane(name, at) result(wall)
        character(*), intent(in) :: name
        real(c_double), intent(in) :: at
        type(fibrad_wall) :: wall
        character(4), parameter :: names(6) = ['xmin', 'xmax', 'ymin', 'ymax', 'zmin', 'zmax']
        integer :: k
        do k = 1, size(names)
            if (name == names(k)) then
                wall%kind = 1
                wall%plane = c_plane((k - 1) / 2, mod(k - 1, 2), at)
            end if
        end do
    end function fibrad_plane

    ! A cylinder about the bed; x and y of its axis, which is parallel to z.
    pure function fibrad_cylinder(x, y, radius) result(wall)
        real(c_double), intent(in) :: x, y, radius
        type(fibrad_wall) :: wall
        wall%kind = 2
        wall%cylinder = c_cylinder(x, y, radius)
    end function fibrad_cylinder

    ! View factors of all spheres by beams. directions: 8 to 65536, 233 if absent; tolerance: as many as bring the
    ! estimated error of each row down to it. raw: rows as they were computed, not averaged.
    subroutine fibrad_view_factors(x, y, z, r, factors, status, box, walls, directions, tolerance, cutoff, raw, threads, &
                                   fault)
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        type(fibrad_factors), intent(out) :: factors
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3), tolerance, cutoff
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        integer, intent(in), optional :: directions, threads
        logical, intent(in), optional :: raw
        integer, intent(out), optional :: fault(2)
        type(c_beam_rule), target :: rule
        type(c_bed_options) :: options
        type(c_run) :: run
        type(c_ptr) :: found
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status /= fibrad_ok) return
        rule%directions = 233
        if (present(tolerance)) rule = c_beam_rule(tolerance=tolerance)
        if (present(directions)) rule%directions = int(directions, c_int32_t)
        if (present(cutoff)) rule%cutoff = cutoff
        options%beam = c_loc(rule)
        options%raw = flag(raw)
        status = c_view_factors(scene_of(box, walls), spheres_of(x, y, z, r), options, run, found)
        call tell_fault(run%fault, size(x), fault)
        if (status == fibrad_ok) call take_factors(found, factors)
    end subroutine fibrad_view_factors

    ! Exchange factors of grey diffuse spheres: what sphere i emits and sphere j absorbs, reflections included.
    ! emissivity: (0, 1], wall_emissivity: [0, 1], needed where there are walls. directions, paths: 50, 400 if absent.
    subroutine fibrad_exchange_factors(x, y, z, r, emissivity, factors, status, box, walls, wall_emissivity, directions, &
                                       paths, tolerance, cutoff, raw, threads, fault)
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:), emissivity(:)
        type(fibrad_factors), intent(out) :: factors
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3), tolerance, cutoff
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        real(c_double), intent(in), optional, contiguous, target :: wall_emissivity(:)
        integer, intent(in), optional :: directions, paths, threads
        logical, intent(in), optional :: raw
        integer, intent(out), optional :: fault(2)
        type(c_exchange_rule) :: rule
        type(c_bed_options) :: options
        type(c_run) :: run
        type(c_ptr) :: found
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r), size(emissivity))
        if (status == fibrad_ok) status = check_sizes(count_walls(walls), count_values(wall_emissivity))
        if (status /= fibrad_ok) return
        rule%emissivity = c_loc(emissivity)
        if (present(wall_emissivity)) rule%body_emissivity = c_loc(wall_emissivity)
        if (present(directions)) rule%directions = int(directions, c_int32_t)
        if (present(paths)) rule%paths = int(paths, c_int32_t)
        if (present(tolerance)) rule%tolerance = tolerance
        if (present(cutoff)) rule%cutoff = cutoff
        options%raw = flag(raw)
        status = c_exchange_factors(scene_of(box, walls), spheres_of(x, y, z, r), rule, options, run, found)
        call tell_fault(run%fault, size(x), fault)
        if (status == fibrad_ok) call take_factors(found, factors)
    end subroutine fibrad_exchange_factors

    ! Makes the problem for a bed and traces its beams. directions, points, patches: 168, 64, 96 if absent.
    subroutine heat_new(heat, x, y, z, r, status, box, walls, directions, points, patches, threads, fault)
        class(fibrad_heat), intent(inout) :: heat
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        integer, intent(in), optional :: directions, points, patches, threads
        integer, intent(out), optional :: fault(2)
        type(c_heat_config) :: config
        type(c_run) :: run
        call heat%free()
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status /= fibrad_ok) return
        if (present(directions)) config%directions = int(directions, c_int32_t)
        if (present(points)) config%points = int(points, c_int32_t)
        if (present(patches)) config%patches = int(patches, c_int32_t)
        status = c_radiation_new(heat%radiation, scene_of(box, walls), spheres_of(x, y, z, r), config, run)
        call tell_fault(run%fault, size(x), fault)
        heat%spheres = size(x)
        heat%walls = count_walls(walls)
    end subroutine heat_new

    ! Goes on to the same spheres and walls at other places; box and walls as in new.
    subroutine heat_move(heat, x, y, z, r, status, box, walls, fault)
        class(fibrad_heat), intent(inout) :: heat
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        integer, intent(out), optional :: fault(2)
        type(c_fault) :: found
        if (present(fault)) fault = 0
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status /= fibrad_ok) return
        status = c_radiation_move(heat%radiation, scene_of(box, walls), spheres_of(x, y, z, r))
        call c_radiation_describe(heat%radiation, c_null_ptr, found)
        if (c_associated(heat%radiation)) call tell_fault(found, size(x), fault)
    end subroutine heat_move

    ! Net powers [W] of spheres, walls and surroundings at these temperatures [K]. Where there are walls their
    ! temperatures and emissivities are needed. error: estimated, root mean square over the spheres [W].
    subroutine heat_solve(heat, temperature, emissivity, surroundings, power, status, wall_temperature, wall_emissivity, &
                          wall_power, surroundings_power, error)
        class(fibrad_heat), intent(inout) :: heat
        real(c_double), intent(in), contiguous, target :: temperature(:), emissivity(:)
        real(c_double), intent(in) :: surroundings
        real(c_double), intent(inout), contiguous, target :: power(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional, contiguous, target :: wall_temperature(:), wall_emissivity(:)
        real(c_double), intent(inout), optional :: wall_power(:)
        real(c_double), intent(inout), optional :: surroundings_power, error
        type(c_heat_sources) :: sources
        type(c_heat_result) :: result
        real(c_double), target :: walls(max(1, heat%walls))
        status = check_sizes(heat%spheres, size(temperature), size(emissivity), size(power))
        if (status == fibrad_ok) status = check_sizes(heat%walls, count_values(wall_temperature), &
                                                      count_values(wall_emissivity))
        if (status == fibrad_ok .and. present(wall_power)) status = check_sizes(heat%walls, size(wall_power))
        if (status /= fibrad_ok) return
        sources%temperature = c_loc(temperature)
        sources%emissivity = c_loc(emissivity)
        if (present(wall_temperature)) sources%body_temperature = c_loc(wall_temperature)
        if (present(wall_emissivity)) sources%body_emissivity = c_loc(wall_emissivity)
        sources%surroundings = surroundings
        result%power = c_loc(power)
        result%body_power = c_loc(walls)
        status = c_radiation_solve(heat%radiation, sources, result)
        if (status /= fibrad_ok) return
        if (present(wall_power)) wall_power = walls(1:heat%walls)
        if (present(surroundings_power)) surroundings_power = result%surroundings_power
        if (present(error)) error = hypot(result%error_patches, result%error_beams)
    end subroutine heat_solve

    ! Gives the memory back; new may follow.
    subroutine heat_free(heat)
        class(fibrad_heat), intent(inout) :: heat
        call c_radiation_free(heat%radiation)
        heat%radiation = c_null_ptr
        heat%spheres = 0
        heat%walls = 0
    end subroutine heat_free

    ! One English sentence for any status; the version of the library.
    function fibrad_status_text(status) result(text)
        integer, intent(in) :: status
        character(:), allocatable :: text
        text = text_of(c_status_text(int(status, c_int)))
    end function fibrad_status_text

    function fibrad_version() result(text)
        character(:), allocatable :: text
        text = text_of(c_version())
    end function fibrad_version

    ! Whether the structures of this module are those of the library.
    logical function fibrad_layouts_agree()
        type(c_spheres) :: spheres
        type(fibrad_wall) :: body
        type(c_scene_config) :: scene_config
        type(c_fault) :: fault
        type(c_scene_facts) :: scene_facts
        type(c_run) :: run
        type(c_beam_rule) :: beam_rule
        type(c_bed_options) :: bed_options
        type(c_factors) :: factors
        type(c_bed_factors) :: bed_factors
        type(c_exchange_rule) :: exchange_rule
        type(c_heat_config) :: heat_config
        type(c_heat_sources) :: heat_sources
        type(c_heat_result) :: heat_result
        fibrad_layouts_agree = all([ &
            agrees('spheres', c_sizeof(spheres)), agrees('body', c_sizeof(body)), &
            agrees('scene_config', c_sizeof(scene_config)), agrees('fault', c_sizeof(fault)), &
            agrees('scene_facts', c_sizeof(scene_facts)), agrees('run', c_sizeof(run)), &
            agrees('beam_rule', c_sizeof(beam_rule)), agrees('bed_options', c_sizeof(bed_options)), &
            agrees('factors', c_sizeof(factors)), agrees('bed_factors', c_sizeof(bed_factors)), &
            agrees('exchange_rule', c_sizeof(exchange_rule)), agrees('heat_config', c_sizeof(heat_config)), &
            agrees('heat_sources', c_sizeof(heat_sources)), agrees('heat_result', c_sizeof(heat_result))])
    end function fibrad_layouts_agree

    logical function agrees(name, bytes)
        character(*), intent(in) :: name
        integer(c_size_t), intent(in) :: bytes
        agrees = c_sizeof_name('fibrad_'//name//c_null_char) == bytes
    end function agrees

    function text_of(from) result(text)
        type(c_ptr), intent(in) :: from
        character(:), allocatable :: text
        character(kind=c_char), pointer :: letters(:)
        integer :: k
        call c_f_pointer(from, letters, [1024])
        text = ''
        do k = 1, size(letters)
            if (letters(k) == c_null_char) exit
            text = text//letters(k)
        end do
    end function text_of

    ! Arrays that belong together have one size.
    pure integer function check_sizes(n, second, third, fourth, fifth)
        integer, intent(in) :: n, second
        integer, intent(in), optional :: third, fourth, fifth
        check_sizes = merge(fibrad_ok, fibrad_e_argument, second == n)
        if (present(third)) check_sizes = merge(check_sizes, fibrad_e_argument, third == n)
        if (present(fourth)) check_sizes = merge(check_sizes, fibrad_e_argument, fourth == n)
        if (present(fifth)) check_sizes = merge(check_sizes, fibrad_e_argument, fifth == n)
    end function check_sizes

    pure integer function count_walls(walls)
        type(fibrad_wall), intent(in), optional :: walls(:)
        count_walls = 0
        if (present(walls)) count_walls = size(walls)
    end function count_walls

    pure integer function count_values(values)
        real(c_double), intent(in), optional :: values(:)
        count_values = 0
        if (present(values)) count_values = size(values)
    end function count_values

    pure integer(c_int) function flag(on)
        logical, intent(in), optional :: on
        flag = 0
        if (present(on)) flag = merge(1, 0, on)
    end function flag

    function spheres_of(x, y, z, r) result(spheres)
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        type(c_spheres) :: spheres
        spheres = c_spheres(x=c_loc(x), y=c_loc(y), z=c_loc(z), r=c_loc(r), n=size(x, kind=c_int32_t))
    end function spheres_of

    function scene_of(box, walls) result(config)
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        type(c_scene_config) :: config
        if (present(box)) config%period = box
        if (present(walls)) then
            config%body = c_loc(walls)
            config%bodies = size(walls, kind=c_int32_t)
        end if
    end function scene_of

    subroutine set_run(run, threads, fault)
        type(c_run), intent(inout) :: run
        integer, intent(in), optional :: threads
        integer, intent(out), optional :: fault(2)
        if (present(threads)) run%threads = int(threads, c_int)
        if (present(fault)) fault = 0
    end subroutine set_run

    ! Spheres concerned, from 1; their number in C: none of them.
    subroutine tell_fault(from, n, fault)
        type(c_fault), intent(in) :: from
        integer, intent(in) :: n
        integer, intent(out), optional :: fault(2)
        if (.not. present(fault)) return
        fault = [from%first, from%second] + 1
        where (fault > n) fault = 0
    end subroutine tell_fault

    ! Copies factors of C into arrays that count from 1, and frees them.
    subroutine take_factors(found, factors)
        type(c_ptr), intent(in) :: found
        type(fibrad_factors), intent(inout) :: factors
        type(c_bed_factors), pointer :: bed
        integer(c_int64_t), pointer :: start(:)
        integer(c_int32_t), pointer :: col(:)
        integer :: n, walls
        call c_f_pointer(found, bed)
        n = bed%matrix%n
        walls = bed%matrix%bodies
        call c_f_pointer(bed%matrix%start, start, [n + 1])
        call c_f_pointer(bed%matrix%col, col, [start(n + 1)])
        factors%start = start + 1
        factors%col = col + 1
        factors%f = reals(bed%matrix%f, start(n + 1))
        factors%escaped = reals(bed%matrix%escaped, int(n, c_int64_t))
        factors%beyond = reals(bed%matrix%beyond, int(n, c_int64_t))
        factors%error = reals(bed%matrix%error, int(n, c_int64_t))
        factors%wall = reshape(reals(bed%matrix%body, int(n, c_int64_t) * walls), [walls, n])
        factors%wall_area = reals(bed%body_area, int(walls, c_int64_t))
        if (c_associated(bed%matrix%body_body)) then
            factors%wall_wall = reshape(reals(bed%matrix%body_body, int(walls, c_int64_t)**2), [walls, walls])
            factors%wall_escaped = reals(bed%matrix%body_escaped, int(walls, c_int64_t))
            factors%wall_error = reals(bed%matrix%body_error, int(walls, c_int64_t))
        end if
        factors%directions = bed%directions
        factors%threads = bed%threads
        factors%seconds = bed%seconds
        factors%closure_error = bed%closure_error
        factors%reciprocity_error = bed%reciprocity_error
        call c_bed_free(found)
    end subroutine take_factors

    function reals(from, n) result(values)
        type(c_ptr), intent(in) :: from
        integer(c_int64_t), intent(in) :: n
        real(c_double), allocatable :: values(:)
        real(c_double), pointer :: there(:)
        allocate (values(n))
        if (n == 0) return
        call c_f_pointer(from, there, [n])
        values = there
    end function reals
end module fibrad
