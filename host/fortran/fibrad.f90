! fibrad.f90 - view factors and thermal radiation of packed beds, in Fortran 2008, over libfibrad.so (fibrad_host.h).
!
! Index
!   walls      fibrad_plane, fibrad_cylinder, fibrad_mesh; fibrad_triangles
!   factors    fibrad_view_factors, fibrad_exchange_factors, fibrad_displacements; fibrad_factors
!   heat       fibrad_heat: new, move, solve, settle, shine, free
!   time       fibrad_transient: new, move, advance, free
!   status     fibrad_status_text, fibrad_version, fibrad_layouts_agree
!
! Arguments that many procedures have
!   x, y, z    (n) [L] centres. For positions (n, 3) pass at(:, 1), at(:, 2), at(:, 3). They are not copied.
!   r          (n) [L] radii
!   status     0, or one of fibrad_e_*. After an error the other results are not set.
!   fault      (2) the spheres at fault: one or two numbers; 0: none. A triangle at fault is minus its number.
!   box        (3) [L] lengths of the periodic box; 0: the axis is open. Absent: all axes are open.
!   walls      by fibrad_plane, fibrad_cylinder and fibrad_mesh. Openings have no number. Absent: none.
!   triangles  of all walls by fibrad_mesh. Needed if there is such a wall. They may move with the bed.
!   threads    0 or absent: OMP_NUM_THREADS, or else all processors
!
! Numbers      Spheres, walls, triangles, rows and columns count from 1.
! Units        One length unit L for factors. Metres, kelvins and watts for powers.
! Powers       A net power is above 0 where heat is gained.
! Words        Words, ranges and errors are those of the C functions of the same name, in fibrad_host.h and fibrad.h.
!
! SPDX-License-Identifier: MIT
module fibrad
    use, intrinsic :: iso_c_binding
    implicit none
    private
    public :: fibrad_plane, fibrad_cylinder, fibrad_mesh, fibrad_view_factors, fibrad_exchange_factors
    public :: fibrad_displacements, fibrad_status_text, fibrad_version, fibrad_layouts_agree

    integer, parameter, public :: fibrad_ok = 0, fibrad_e_argument = -1, fibrad_e_geometry = -6, fibrad_e_state = -8, &
                                  fibrad_e_unsupported = -10, fibrad_e_memory = -11, fibrad_e_unsolvable = -13, &
                                  fibrad_e_back = -14, fibrad_e_sum = -15, fibrad_e_endless = -16, fibrad_e_file = -17
    integer(c_int), parameter :: kind_open = -1 ! of fibrad_wall; C has a list of its own for openings
    real(c_double), parameter, public :: fibrad_stefan_boltzmann = 5.670374419e-8_c_double

    ! ---- of C, by `make structures`
    type, bind(C) :: c_plane
        integer(c_int) :: axis = 0, upper = 0
        real(c_double) :: at = 0
    end type c_plane

    type, bind(C) :: c_cylinder
        real(c_double) :: x = 0, y = 0, radius = 0
        integer(c_int) :: along = 0
    end type c_cylinder

    type, bind(C), public :: fibrad_wall
        integer(c_int) :: kind = 0
        type(c_plane) :: plane
        type(c_cylinder) :: cylinder
    end type fibrad_wall

    type, bind(C) :: c_occupancy
        real(c_double) :: low(3) = 0, high(3) = 0
        integer(c_int32_t) :: cells(3) = 0
        integer(c_int) :: periodic(3) = 0
        type(c_ptr) :: mark = c_null_ptr
    end type c_occupancy

    type, bind(C) :: c_triangles
        type(c_ptr) :: x = c_null_ptr, y = c_null_ptr, z = c_null_ptr
        integer(c_int32_t) :: stride = 3, vertices = 0
        type(c_ptr) :: corner = c_null_ptr, front = c_null_ptr, back = c_null_ptr
        integer(c_int32_t) :: n = 0
        real(c_double) :: period(3) = 0
    end type c_triangles

    type, bind(C) :: c_scene_config
        integer(c_int) :: isa = 0
        real(c_double) :: period(3) = 0
        type(c_ptr) :: wall = c_null_ptr
        integer(c_int32_t) :: walls = 0
        type(c_ptr) :: opening = c_null_ptr
        integer(c_int32_t) :: openings = 0
        type(c_ptr) :: occupancy = c_null_ptr, triangles = c_null_ptr
    end type c_scene_config

    type, bind(C) :: c_spheres
        type(c_ptr) :: x = c_null_ptr, y = c_null_ptr, z = c_null_ptr, r = c_null_ptr
        integer(c_int32_t) :: n = 0, stride = 0, stride_r = 0
        type(c_ptr) :: id = c_null_ptr
    end type c_spheres

    type, bind(C) :: c_fault
        integer(c_int32_t) :: first = 0, second = 0, triangle = -1, wall = 0
        integer(c_int) :: why = 0
    end type c_fault

    type, bind(C) :: c_run
        integer(c_int) :: threads = 0
        type(c_funptr) :: progress = c_null_funptr
        type(c_ptr) :: context = c_null_ptr
        type(c_fault) :: fault
    end type c_run

    type, bind(C) :: c_scene_facts
        integer(c_int32_t) :: spheres = 0, walls = 0
        integer(c_int) :: isa = 0
        integer(c_int32_t) :: cells = 0
        real(c_double) :: radius_min = 0, radius_max = 0, overlap_max = 0
        integer(c_int32_t) :: overlap_pair(2) = 0, triangles = 0
    end type c_scene_facts

    type, bind(C) :: c_warning
        integer(c_int) :: code = 0
        integer(c_int32_t) :: first = 0, second = 0, wall = 0, count = 0
        real(c_double) :: value = 0, other = 0
    end type c_warning

    type, bind(C) :: c_beam_rule
        integer(c_int32_t) :: directions = 0, points = 0
        real(c_double) :: cutoff = 0, tolerance = 0
        integer(c_int64_t) :: turn = 0
        type(c_ptr) :: lines = c_null_ptr
        integer(c_int32_t) :: chords = 0
    end type c_beam_rule

    type, bind(C) :: c_cast_rule
        integer(c_int32_t) :: rays = 0
        integer(c_int) :: random = 0
        integer(c_int64_t) :: seed = 0
        real(c_double) :: cutoff = 0
    end type c_cast_rule

    type, bind(C) :: c_exchange_rule
        type(c_ptr) :: emissivity = c_null_ptr, wall_emissivity = c_null_ptr
        integer(c_int32_t) :: directions = 0, paths = 0
        integer(c_int64_t) :: seed = 0
        real(c_double) :: cutoff = 0, tolerance = 0
        type(c_ptr) :: node_emissivity = c_null_ptr
        real(c_double) :: open_error = 0
        type(c_ptr) :: conductivity = c_null_ptr, known = c_null_ptr
        real(c_double) :: known_paths = 0
    end type c_exchange_rule

    type, bind(C) :: c_bed_rule
        type(c_ptr) :: beam = c_null_ptr, cast = c_null_ptr, exchange = c_null_ptr, wanted = c_null_ptr
        integer(c_int) :: raw = 0
        real(c_double) :: drop = 0
        integer(c_int) :: walls = 0
        type(c_ptr) :: scratch = c_null_ptr
    end type c_bed_rule

    type, bind(C) :: c_factors
        integer(c_int32_t) :: n = 0, walls = 0
        type(c_ptr) :: start = c_null_ptr, col = c_null_ptr, f = c_null_ptr, escaped = c_null_ptr, &
            beyond = c_null_ptr, error = c_null_ptr, wall = c_null_ptr, wall_wall = c_null_ptr, &
            wall_escaped = c_null_ptr, wall_error = c_null_ptr
        real(c_double) :: wall_correction = 0, wall_closure = 0, changed = 0
        integer(c_int32_t) :: changed_row = 0
    end type c_factors

    type, bind(C) :: c_bed_matrix
        type(c_factors) :: matrix
        type(c_scene_facts) :: facts
        type(c_ptr) :: wall_area = c_null_ptr
        integer(c_int) :: threads = 0
        integer(c_int32_t) :: directions = 0
        integer(c_int64_t) :: fallbacks = 0, rays = 0
        real(c_double) :: seconds = 0, closure_error = 0, reciprocity_error = 0
    end type c_bed_matrix

    type, bind(C) :: c_wall_rule
        type(c_ptr) :: emissivity = c_null_ptr, wall_emissivity = c_null_ptr, node_emissivity = c_null_ptr, &
            conductivity = c_null_ptr
        integer(c_int32_t) :: paths = 0
        integer(c_int64_t) :: seed = 0
    end type c_wall_rule

    type, bind(C) :: c_wall_row
        real(c_double) :: wall(32) = 0, spheres = 0, escaped = 0, error = 0
        integer(c_int64_t) :: rays = 0, paths = 0
    end type c_wall_row

    type, bind(C) :: c_displacement_rule
        type(c_ptr) :: emissivity = c_null_ptr, wall_emissivity = c_null_ptr, conductivity = c_null_ptr
        integer(c_int32_t) :: flights = 0, paths = 0
        integer(c_int64_t) :: seed = 0
    end type c_displacement_rule

    type, bind(C) :: c_displacement
        real(c_double) :: square(3) = 0, error(3) = 0, absorbed = 0
        integer(c_int64_t) :: rays = 0
    end type c_displacement

    type, bind(C) :: c_heat_config
        integer(c_int32_t) :: directions = 0, points = 0, patches = 0, parts = 0, wall_rays = 0
    end type c_heat_config

    type, bind(C) :: c_heat_sources
        type(c_ptr) :: temperature = c_null_ptr, emissivity = c_null_ptr, power = c_null_ptr, storage = c_null_ptr, &
            reference = c_null_ptr, wall_temperature = c_null_ptr, wall_emissivity = c_null_ptr, &
            wall_power = c_null_ptr, insulated = c_null_ptr
        real(c_double) :: surroundings = 0, sigma = fibrad_stefan_boltzmann, tolerance = 0
        integer(c_int32_t) :: sweeps_max = 0
        type(c_ptr) :: side_temperature = c_null_ptr, light = c_null_ptr, conductivity = c_null_ptr, &
            absorbed = c_null_ptr, contact_first = c_null_ptr, contact_second = c_null_ptr, conductance = c_null_ptr
        integer(c_int32_t) :: contacts = 0
        type(c_ptr) :: contact_places = c_null_ptr
    end type c_heat_sources

    type, bind(C) :: c_law
        type(c_funptr) :: follow = c_null_funptr
        type(c_ptr) :: context = c_null_ptr, emissivity = c_null_ptr, wall_emissivity = c_null_ptr
    end type c_law

    type, bind(C) :: c_heat_result
        type(c_ptr) :: power = c_null_ptr, wall_power = c_null_ptr
        real(c_double) :: surroundings_power = 0
        type(c_ptr) :: temperature = c_null_ptr, wall_temperature = c_null_ptr, power_error = c_null_ptr, &
            wall_error = c_null_ptr, temperature_error = c_null_ptr, wall_temperature_error = c_null_ptr
        real(c_double) :: error_patches = 0, error_beams = 0, residual = 0
        integer(c_int32_t) :: sweeps = 0
        type(c_ptr) :: wall_absorbed = c_null_ptr
        real(c_double) :: surroundings_error = 0
        type(c_ptr) :: wall_area = c_null_ptr, least_temperature = c_null_ptr, largest_temperature = c_null_ptr, &
            centre_temperature = c_null_ptr, surface_error = c_null_ptr, centre_error = c_null_ptr, &
            conducted = c_null_ptr, wall_conducted = c_null_ptr, contact_flow = c_null_ptr
    end type c_heat_result

    type, bind(C), public :: fibrad_light
        real(c_double) :: direction(3) = 0, flux = 0, half_angle = 0
        integer(c_int32_t) :: directions = 0
        integer(c_int) :: shape = 0
        real(c_double) :: centre(3) = 0, radius = 0, low(2) = 0, high(2) = 0
    end type fibrad_light

    type, bind(C) :: c_light_sources
        type(c_ptr) :: light = c_null_ptr
        integer(c_int32_t) :: lights = 0
        type(c_ptr) :: absorptivity = c_null_ptr, wall_absorptivity = c_null_ptr
        real(c_double) :: tolerance = 0
    end type c_light_sources

    type, bind(C) :: c_light_result
        type(c_ptr) :: absorbed = c_null_ptr, absorbed_first = c_null_ptr, absorbed_error = c_null_ptr, &
            wall_absorbed = c_null_ptr, wall_absorbed_first = c_null_ptr, wall_absorbed_error = c_null_ptr
        real(c_double) :: incident = 0, transmitted = 0, reflected = 0, error = 0, error_patches = 0
        integer(c_int32_t) :: sweeps = 0, lights = 0
        type(c_ptr) :: patches = c_null_ptr
    end type c_light_result

    type, bind(C) :: c_span
        type(c_ptr) :: temperature = c_null_ptr, capacity = c_null_ptr
        real(c_double) :: duration = 0
        type(c_ptr) :: wall_temperature = c_null_ptr, surroundings = c_null_ptr
        real(c_double) :: step = 0, tolerance = 0
        type(c_ptr) :: power = c_null_ptr, wall_power = c_null_ptr
        real(c_double) :: surroundings_power = 0
        type(c_ptr) :: wall_energy = c_null_ptr
        real(c_double) :: surroundings_energy = 0
        type(c_ptr) :: law = c_null_ptr
        type(c_funptr) :: observe = c_null_funptr
        type(c_ptr) :: context = c_null_ptr
        real(c_double) :: error = 0
        integer(c_int64_t) :: steps = 0, refused = 0, sweeps = 0, corrections = 0
    end type c_span

    type, bind(C) :: c_contact_rule
        integer(c_int) :: spots = 0
        real(c_double) :: scale = 0, gas_reach = 0, gas_jump = 0, gas_least = 0
        integer(c_int) :: gas_alone = 0
    end type c_contact_rule

    type, bind(C) :: c_contact_list
        integer(c_int32_t) :: n = 0
        type(c_ptr) :: first = c_null_ptr, second = c_null_ptr, distance = c_null_ptr, radius = c_null_ptr, &
            other = c_null_ptr, spot = c_null_ptr
    end type c_contact_list

    interface
        function c_status_text(status) bind(C, name="fibrad_status_text")
            import
            integer(c_int), value :: status
            type(c_ptr) :: c_status_text
        end function c_status_text
        function c_version() bind(C, name="fibrad_version")
            import
            type(c_ptr) :: c_version
        end function c_version
        function c_why_text(why) bind(C, name="fibrad_why_text")
            import
            integer(c_int), value :: why
            type(c_ptr) :: c_why_text
        end function c_why_text
        function c_node_emissivity(emissivity, conductivity) bind(C, name="fibrad_node_emissivity")
            import
            real(c_double), value :: emissivity
            real(c_double), value :: conductivity
            real(c_double) :: c_node_emissivity
        end function c_node_emissivity
        function c_bed_new(bed, config, spheres, run) bind(C, name="fibrad_bed_new")
            import
            type(c_ptr), intent(out) :: bed
            type(c_scene_config), intent(in) :: config
            type(c_spheres), intent(in) :: spheres
            type(c_run), intent(inout) :: run
            integer(c_int) :: c_bed_new
        end function c_bed_new
        function c_bed_move(bed, config, spheres) bind(C, name="fibrad_bed_move")
            import
            type(c_ptr), value :: bed
            type(c_scene_config), intent(in) :: config
            type(c_spheres), intent(in) :: spheres
            integer(c_int) :: c_bed_move
        end function c_bed_move
        subroutine c_bed_describe(bed, facts, fault) bind(C, name="fibrad_bed_describe")
            import
            type(c_ptr), value :: bed
            type(c_scene_facts), intent(inout) :: facts
            type(c_fault), intent(inout) :: fault
        end subroutine c_bed_describe
        function c_bed_warnings(bed, warning) bind(C, name="fibrad_bed_warnings")
            import
            type(c_ptr), value :: bed
            type(c_warning), intent(inout) :: warning
            integer(c_int32_t) :: c_bed_warnings
        end function c_bed_warnings
        subroutine c_bed_free(bed) bind(C, name="fibrad_bed_free")
            import
            type(c_ptr), value :: bed
        end subroutine c_bed_free
        function c_bed_factors(bed, rule, matrix) bind(C, name="fibrad_bed_factors")
            import
            type(c_ptr), value :: bed
            type(c_bed_rule), intent(in) :: rule
            type(c_ptr), intent(out) :: matrix
            integer(c_int) :: c_bed_factors
        end function c_bed_factors
        subroutine c_bed_matrix_free(matrix) bind(C, name="fibrad_bed_matrix_free")
            import
            type(c_bed_matrix), intent(inout) :: matrix
        end subroutine c_bed_matrix_free
        function c_view_factors(config, spheres, rule, run, matrix) bind(C, name="fibrad_view_factors")
            import
            type(c_scene_config), intent(in) :: config
            type(c_spheres), intent(in) :: spheres
            type(c_bed_rule), intent(in) :: rule
            type(c_run), intent(inout) :: run
            type(c_ptr), intent(out) :: matrix
            integer(c_int) :: c_view_factors
        end function c_view_factors
        function c_bed_wall_row(bed, wall, rule, tolerance, row) bind(C, name="fibrad_bed_wall_row")
            import
            type(c_ptr), value :: bed
            integer(c_int32_t), value :: wall
            type(c_wall_rule), intent(in) :: rule
            real(c_double), value :: tolerance
            type(c_wall_row), intent(inout) :: row
            integer(c_int) :: c_bed_wall_row
        end function c_bed_wall_row
        function c_bed_displacements(bed, rule, wanted, displacement) bind(C, name="fibrad_bed_displacements")
            import
            type(c_ptr), value :: bed
            type(c_displacement_rule), intent(in) :: rule
            type(c_ptr), value :: wanted
            type(c_displacement), intent(inout) :: displacement(*)
            integer(c_int) :: c_bed_displacements
        end function c_bed_displacements
        function c_bed_beams(bed, config) bind(C, name="fibrad_bed_beams")
            import
            type(c_ptr), value :: bed
            type(c_heat_config), intent(in) :: config
            integer(c_int) :: c_bed_beams
        end function c_bed_beams
        function c_bed_solve(bed, sources, law, result) bind(C, name="fibrad_bed_solve")
            import
            type(c_ptr), value :: bed
            type(c_heat_sources), intent(in) :: sources
            type(c_law), intent(inout) :: law
            type(c_heat_result), intent(inout) :: result
            integer(c_int) :: c_bed_solve
        end function c_bed_solve
        function c_bed_sides(bed, flux, temperature) bind(C, name="fibrad_bed_sides")
            import
            type(c_ptr), value :: bed
            type(c_ptr), value :: flux
            type(c_ptr), value :: temperature
            integer(c_int) :: c_bed_sides
        end function c_bed_sides
        function c_bed_shine(bed, sources, result) bind(C, name="fibrad_bed_shine")
            import
            type(c_ptr), value :: bed
            type(c_light_sources), intent(in) :: sources
            type(c_light_result), intent(inout) :: result
            integer(c_int) :: c_bed_shine
        end function c_bed_shine
        function c_bed_advance(bed, sources, span) bind(C, name="fibrad_bed_advance")
            import
            type(c_ptr), value :: bed
            type(c_heat_sources), intent(in) :: sources
            type(c_span), intent(inout) :: span
            integer(c_int) :: c_bed_advance
        end function c_bed_advance
        function c_bed_contacts(bed, rule, list) bind(C, name="fibrad_bed_contacts")
            import
            type(c_ptr), value :: bed
            type(c_contact_rule), intent(in) :: rule
            type(c_ptr), intent(out) :: list
            integer(c_int) :: c_bed_contacts
        end function c_bed_contacts
        function c_contacts_conduct(list, rule, solid, gas, conductance) bind(C, name="fibrad_contacts_conduct")
            import
            type(c_contact_list), intent(in) :: list
            type(c_contact_rule), intent(in) :: rule
            type(c_ptr), value :: solid
            type(c_ptr), value :: gas
            type(c_ptr), value :: conductance
            integer(c_int) :: c_contacts_conduct
        end function c_contacts_conduct
        function c_heap_resize(context, block, size) bind(C, name="fibrad_heap_resize")
            import
            type(c_ptr), value :: context
            type(c_ptr), value :: block
            integer(c_size_t), value :: size
            type(c_ptr) :: c_heap_resize
        end function c_heap_resize
        function c_host_sizeof(name) bind(C, name="fibrad_host_sizeof")
            import
            character(kind=c_char), intent(in) :: name(*)
            integer(c_size_t) :: c_host_sizeof
        end function c_host_sizeof
    end interface

    character(24), parameter :: c_names(31) = [character(24) :: &
        'fibrad_plane', 'fibrad_cylinder', 'fibrad_wall', 'fibrad_occupancy', 'fibrad_triangles', &
        'fibrad_scene_config', 'fibrad_spheres', 'fibrad_fault', 'fibrad_run', 'fibrad_scene_facts', 'fibrad_warning', &
        'fibrad_beam_rule', 'fibrad_cast_rule', 'fibrad_exchange_rule', 'fibrad_bed_rule', 'fibrad_factors', &
        'fibrad_bed_matrix', 'fibrad_wall_rule', 'fibrad_wall_row', 'fibrad_displacement_rule', 'fibrad_displacement', &
        'fibrad_heat_config', 'fibrad_heat_sources', 'fibrad_law', 'fibrad_heat_result', 'fibrad_light', &
        'fibrad_light_sources', 'fibrad_light_result', 'fibrad_span', 'fibrad_contact_rule', 'fibrad_contact_list']
    integer, parameter :: c_bits(31) = [ &
        storage_size(c_plane()), storage_size(c_cylinder()), storage_size(fibrad_wall()), storage_size(c_occupancy()), &
        storage_size(c_triangles()), storage_size(c_scene_config()), storage_size(c_spheres()), &
        storage_size(c_fault()), storage_size(c_run()), storage_size(c_scene_facts()), storage_size(c_warning()), &
        storage_size(c_beam_rule()), storage_size(c_cast_rule()), storage_size(c_exchange_rule()), &
        storage_size(c_bed_rule()), storage_size(c_factors()), storage_size(c_bed_matrix()), &
        storage_size(c_wall_rule()), storage_size(c_wall_row()), storage_size(c_displacement_rule()), &
        storage_size(c_displacement()), storage_size(c_heat_config()), storage_size(c_heat_sources()), &
        storage_size(c_law()), storage_size(c_heat_result()), storage_size(fibrad_light()), &
        storage_size(c_light_sources()), storage_size(c_light_result()), storage_size(c_span()), &
        storage_size(c_contact_rule()), storage_size(c_contact_list())]
    ! ---- end of what `make structures` writes

    ! The triangles of all walls that are meshes. Seen from its front, the corners of a triangle go counter-clockwise. A
    ! side that belongs to no wall must not be seen.
    type, public :: fibrad_triangles
        real(c_double), allocatable :: vertex(:, :)    ! L, (3, vertices)
        integer(c_int32_t), allocatable :: corner(:, :) ! (3, triangles), vertices of each triangle
        integer(c_int32_t), allocatable :: front(:)     ! (triangles), wall of each front side; 0: none
        integer(c_int32_t), allocatable :: back(:)      ! (triangles), wall of each back side; 0: none; or not allocated
    end type fibrad_triangles

    type :: walls_of_c ! walls as C takes them: openings in a list of their own, triangles counted from 0
        type(fibrad_wall), allocatable :: wall(:)
        type(c_plane), allocatable :: opening(:)
        real(c_double), allocatable :: vertex(:, :)
        integer(c_int32_t), allocatable :: corner(:, :), front(:), back(:)
        type(c_triangles) :: given
    end type walls_of_c

    abstract interface
        ! A function of the caller: emissivities that depend on temperatures. Where a temperature is NaN, leave the
        ! emissivity as it is.
        !   temperature  (n) [K]
        !   emissivity   (n) 0 to 1
        subroutine fibrad_law(temperature, emissivity)
            import :: c_double
            real(c_double), intent(in) :: temperature(:)
            real(c_double), intent(inout) :: emissivity(:)
        end subroutine fibrad_law
    end interface
    public :: fibrad_law

    type :: law_of_spheres ! C hands this back to follow_law
        procedure(fibrad_law), pointer, nopass :: law => null()
        integer :: n = 0
    end type law_of_spheres

    ! ---- results
    ! A matrix of factors in compressed rows. The sum of f of row i, wall(:, i), escaped(i) and beyond(i) is 1.
    type, public :: fibrad_factors
        integer(c_int64_t), allocatable :: start(:) ! (n + 1), row i is elements start(i) to start(i + 1) - 1
        integer(c_int32_t), allocatable :: col(:)   ! (start(n + 1) - 1), spheres that receive, ascending in a row
        real(c_double), allocatable :: f(:)         ! (start(n + 1) - 1), factor from sphere i to sphere col
        real(c_double), allocatable :: escaped(:)   ! (n), factor to the surroundings
        real(c_double), allocatable :: beyond(:)    ! (n), fraction whose target is not known, beyond the cutoff
        real(c_double), allocatable :: error(:)     ! (n), estimated error of each row: root of the sum of squares
        real(c_double), allocatable :: wall(:, :)   ! (walls, n), factors to walls
        real(c_double), allocatable :: wall_area(:) ! L^2, (walls)
        ! The next three are not allocated with a cutoff. They are NaN for an endless wall.
        real(c_double), allocatable :: wall_wall(:, :) ! (walls, walls), element (j, i) from wall i to wall j
        real(c_double), allocatable :: wall_escaped(:) ! (walls), factors from walls to the surroundings
        real(c_double), allocatable :: wall_error(:)   ! (walls), estimated error of wall_wall and wall_escaped
        real(c_double), allocatable :: node_emissivity(:) ! (n), of spheres that conduct; else not allocated
        integer :: directions = 0 ! largest number of directions of a row
        integer :: threads = 0    ! threads used
        real(c_double) :: seconds = 0           ! s, of computing
        real(c_double) :: closure_error = 0     ! largest |sum - 1| of a raw row
        real(c_double) :: reciprocity_error = 0 ! largest |A_i F_ij - A_j F_ji|/max(A_i, A_j)
    end type fibrad_factors

    ! The heat problem of a bed that may move. Do not copy it: `free` returns its memory.
    type, public :: fibrad_heat
        private
        type(c_ptr) :: radiation = c_null_ptr
        integer :: spheres = 0, walls = 0
    contains
        procedure, public :: new => heat_new
        procedure, public :: move => heat_move
        procedure, public :: solve => heat_solve
        procedure, public :: settle => heat_settle
        procedure, public :: shine => heat_shine
        procedure, public :: free => heat_free
    end type fibrad_heat

    ! A bed whose temperatures change with time. Do not copy it: `free` returns its memory.
    integer, parameter, public :: fibrad_corrected = 0, fibrad_patches = 1, fibrad_factors_alone = 2
    type, public :: fibrad_transient
        private
        type(c_ptr) :: transient = c_null_ptr
        integer :: spheres = 0, walls = 0
    contains
        procedure, public :: new => transient_new
        procedure, public :: move => transient_move
        procedure, public :: advance => transient_advance
        procedure, public :: free => transient_free
    end type fibrad_transient

contains

    ! A plane across an axis. The bed lies above a min plane and below a max plane.
    !   name  'xmin', 'xmax', 'ymin', 'ymax', 'zmin' or 'zmax'. A wall of another name is refused where it is used.
    !   at    [L] coordinate of the plane on its axis
    !   open  .true.: an opening. The container ends there and the surroundings begin. An opening may stand among the
    !         walls, but it has no number, no temperature and no emissivity.
    pure function fibrad_plane(name, at, open) result(wall)
        character(*), intent(in) :: name
        real(c_double), intent(in) :: at
        logical, intent(in), optional :: open
        type(fibrad_wall) :: wall
        character(4), parameter :: names(6) = ['xmin', 'xmax', 'ymin', 'ymax', 'zmin', 'zmax']
        integer :: k
        do k = 1, size(names)
            if (name == names(k)) then
                wall%kind = 1
                if (flag(open) /= 0) wall%kind = kind_open
                wall%plane = c_plane((k - 1) / 2, mod(k - 1, 2), at)
            end if
        end do
    end function fibrad_plane

    ! A cylinder around the bed.
    !   x, y    [L] position on the two axes across it, in the order x, y, z
    !   radius  [L] above 0
    !   along   'x', 'y' or 'z', the axis to which it is parallel; absent: 'z'. A cylinder along another letter is
    !           refused where it is used.
    pure function fibrad_cylinder(x, y, radius, along) result(wall)
        real(c_double), intent(in) :: x, y, radius
        character(1), intent(in), optional :: along
        type(fibrad_wall) :: wall
        integer(c_int) :: axis
        axis = 2
        if (present(along)) axis = int(index('xyz', along), c_int) - 1
        wall%kind = 2
        wall%cylinder = c_cylinder(x, y, radius, axis)
    end function fibrad_cylinder

    ! A wall of triangles: those of fibrad_triangles that have its number.
    pure function fibrad_mesh() result(wall)
        type(fibrad_wall) :: wall
        wall%kind = 3
    end function fibrad_mesh

    ! View factors of all spheres, by beams.
    !   factors     the matrix
    !   directions  8 to 65536; absent: 233, for all rows of a bed 181 lines, 233 among walls, more for few spheres
    !   tolerance   the error allowed in each row; directions are added until it is met; absent: none
    !   cutoff      [L] spheres farther away are left out; absent: none
    !   raw         .true.: rows as they were computed, not averaged
    subroutine fibrad_view_factors(x, y, z, r, factors, status, box, walls, directions, tolerance, cutoff, raw, threads, &
                                   fault, triangles)
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        type(fibrad_factors), intent(out) :: factors
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3), tolerance, cutoff
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        type(fibrad_triangles), intent(in), optional :: triangles
        integer, intent(in), optional :: directions, threads
        logical, intent(in), optional :: raw
        integer, intent(out), optional :: fault(2)
        type(walls_of_c), target :: mesh
        type(c_beam_rule), target :: rule
        type(c_bed_options) :: options
        type(c_run) :: run
        type(c_ptr) :: found
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status == fibrad_ok) status = copy_triangles(triangles, mesh)
        if (status /= fibrad_ok) return
        if (present(tolerance)) rule = c_beam_rule(tolerance=tolerance)
        if (present(directions)) rule%directions = int(directions, c_int32_t)
        if (present(cutoff)) rule%cutoff = cutoff
        options%beam = c_loc(rule)
        options%raw = flag(raw)
        status = c_view_factors(scene_of(box, walls, mesh), spheres_of(x, y, z, r), options, run, found)
        call tell_fault(run%fault, size(x), fault)
        if (status == fibrad_ok) call take_factors(found, factors)
    end subroutine fibrad_view_factors

    ! Exchange factors of grey diffuse spheres: the fraction of the emission of sphere i that sphere j absorbs, directly
    ! or after diffuse reflections.
    !   emissivity       (n) 0 to 1
    !   factors          the matrix
    !   wall_emissivity  (walls) 0 to 1, needed with walls
    !   directions       of the first segment; absent: 50
    !   paths            for reflections; absent: 400
    !   tolerance        the error allowed in each row; directions and paths are added until it is met; absent: none
    !   cutoff           [L] spheres farther away are left out; absent: none
    !   raw              .true.: rows as they were computed, not averaged
    !   k_star           (n) relative conductivities k_s/(4 d sigma T^3), from 1e-6, of spheres whose temperatures differ
    !                    from point to point. Factors are then between nodes of emissivities factors%node_emissivity,
    !                    and powers follow from a linear system (fibrad_node_emissivity in fibrad.h). Absent: each
    !                    sphere has one temperature.
    subroutine fibrad_exchange_factors(x, y, z, r, emissivity, factors, status, box, walls, wall_emissivity, directions, &
                                       paths, tolerance, cutoff, raw, threads, fault, triangles, k_star)
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:), emissivity(:)
        type(fibrad_factors), intent(out) :: factors
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3), tolerance, cutoff
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        type(fibrad_triangles), intent(in), optional :: triangles
        real(c_double), intent(in), optional, contiguous, target :: wall_emissivity(:), k_star(:)
        integer, intent(in), optional :: directions, paths, threads
        logical, intent(in), optional :: raw
        integer, intent(out), optional :: fault(2)
        type(walls_of_c), target :: mesh
        type(c_exchange_rule) :: rule
        type(c_bed_options) :: options
        type(c_run) :: run
        type(c_ptr) :: found
        real(c_double), allocatable, target :: node(:)
        integer :: i
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r), size(emissivity))
        if (status == fibrad_ok) status = check_sizes(count_walls(walls), count_values(wall_emissivity))
        if (status == fibrad_ok .and. present(k_star)) status = check_sizes(size(x), size(k_star))
        if (status == fibrad_ok) status = copy_triangles(triangles, mesh)
        if (status /= fibrad_ok) return
        rule%emissivity = c_loc(emissivity)
        if (present(wall_emissivity)) rule%wall_emissivity = c_loc(wall_emissivity)
        if (present(k_star)) then
            rule%conductivity = c_loc(k_star)
            node = [(c_node_emissivity(emissivity(i), k_star(i)), i = 1, size(x))]
            rule%node_emissivity = c_loc(node)
        end if
        if (present(directions)) rule%directions = int(directions, c_int32_t)
        if (present(paths)) rule%paths = int(paths, c_int32_t)
        if (present(tolerance)) rule%tolerance = tolerance
        if (present(cutoff)) rule%cutoff = cutoff
        options%raw = flag(raw)
        status = c_exchange_factors(scene_of(box, walls, mesh), spheres_of(x, y, z, r), rule, options, run, found)
        call tell_fault(run%fault, size(x), fault)
        if (status /= fibrad_ok) return
        call take_factors(found, factors)
        call move_alloc(node, factors%node_emissivity)
    end subroutine fibrad_exchange_factors

    ! How far the emission of each sphere is carried. The conductivity of a bed follows from it. If spheres conduct, the
    ! result is how far a path gets in a flight. In a periodic box equal spheres of diameter d, solid fraction phi and
    ! emissivity e have k = 4 sigma T^3 3 phi e sum(square(axis, :))/(n d). If they conduct, e is left out.
    !   square        (3, n) [L^2] mean square displacement along each axis, from centre to centre
    !   error         (3, n) [L^2] its estimated standard error
    !   absorbed      (n) fraction of the emission that spheres absorb; if they conduct, of paths that stay in the bed
    !   k_star        (n) as for fibrad_exchange_factors, without walls
    !   paths         from each sphere; absent: 400
    !   flights       with k_star: flights whose displacements are correlated, 1 to 256; absent: 12
    subroutine fibrad_displacements(x, y, z, r, emissivity, square, status, box, walls, wall_emissivity, k_star, &
                                    paths, flights, error, absorbed, threads, fault, triangles)
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:), emissivity(:)
        real(c_double), intent(out) :: square(:, :)
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        real(c_double), intent(in), optional, contiguous, target :: wall_emissivity(:), k_star(:)
        integer, intent(in), optional :: paths, flights, threads
        real(c_double), intent(out), optional :: error(:, :), absorbed(:)
        integer, intent(out), optional :: fault(2)
        type(fibrad_triangles), intent(in), optional :: triangles
        type(walls_of_c), target :: mesh
        type(c_displacement_rule) :: rule
        type(c_run) :: run
        type(c_displacement), allocatable :: found(:)
        type(c_scene_facts) :: facts
        integer :: i
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r), size(emissivity))
        if (status == fibrad_ok) status = check_sizes(3 * size(x), size(square))
        if (status == fibrad_ok .and. present(error)) status = check_sizes(3 * size(x), size(error))
        if (status == fibrad_ok .and. present(absorbed)) status = check_sizes(size(x), size(absorbed))
        if (status == fibrad_ok .and. present(k_star)) status = check_sizes(size(x), size(k_star))
        if (status == fibrad_ok) status = check_sizes(count_walls(walls), count_values(wall_emissivity))
        if (status == fibrad_ok) status = copy_triangles(triangles, mesh)
        if (status /= fibrad_ok) return
        rule%emissivity = c_loc(emissivity)
        if (present(wall_emissivity)) rule%wall_emissivity = c_loc(wall_emissivity)
        if (present(k_star)) rule%conductivity = c_loc(k_star)
        if (present(paths)) rule%paths = int(paths, c_int32_t)
        if (present(flights)) rule%flights = int(flights, c_int32_t)
        allocate (found(size(x)))
        status = c_displacements(scene_of(box, walls, mesh), spheres_of(x, y, z, r), rule, c_null_ptr, run, found, facts)
        call tell_fault(run%fault, size(x), fault)
        if (status /= fibrad_ok) return
        do i = 1, size(x)
            square(:, i) = found(i)%square
            if (present(error)) error(:, i) = found(i)%error
            if (present(absorbed)) absorbed(i) = found(i)%absorbed
        end do
    end subroutine fibrad_displacements

    ! Makes the heat problem of a bed and traces its beams.
    !   directions  of beams from each sphere, 8 to 65536; absent: 168
    !   points      of each beam, 64, 128 or 256; absent: 64
    !   patches     of each sphere, 24, 96 or 384; absent: 96
    subroutine heat_new(heat, x, y, z, r, status, box, walls, directions, points, patches, threads, fault, triangles)
        class(fibrad_heat), intent(inout) :: heat
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        type(fibrad_triangles), intent(in), optional :: triangles
        integer, intent(in), optional :: directions, points, patches, threads
        integer, intent(out), optional :: fault(2)
        type(walls_of_c), target :: mesh
        type(c_heat_config) :: config
        type(c_run) :: run
        call heat%free()
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status == fibrad_ok) status = copy_triangles(triangles, mesh)
        if (status /= fibrad_ok) return
        if (present(directions)) config%directions = int(directions, c_int32_t)
        if (present(points)) config%points = int(points, c_int32_t)
        if (present(patches)) config%patches = int(patches, c_int32_t)
        status = c_radiation_new(heat%radiation, scene_of(box, walls, mesh), spheres_of(x, y, z, r), config, run)
        call tell_fault(run%fault, size(x), fault)
        heat%spheres = size(x)
        heat%walls = count_walls(walls)
    end subroutine heat_new

    ! Goes on with the same spheres and walls at other positions. The arguments are those of `new`.
    subroutine heat_move(heat, x, y, z, r, status, box, walls, fault, triangles)
        class(fibrad_heat), intent(inout) :: heat
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        type(fibrad_triangles), intent(in), optional :: triangles
        integer, intent(out), optional :: fault(2)
        type(walls_of_c), target :: mesh
        type(c_fault) :: found
        type(c_scene_facts) :: facts
        if (present(fault)) fault = 0
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status == fibrad_ok) status = copy_triangles(triangles, mesh)
        if (status /= fibrad_ok) return
        status = c_radiation_move(heat%radiation, scene_of(box, walls, mesh), spheres_of(x, y, z, r))
        call c_radiation_describe(heat%radiation, facts, found)
        if (c_associated(heat%radiation)) call tell_fault(found, size(x), fault)
    end subroutine heat_move

    ! Net powers at given temperatures.
    !   temperature         (n) [K]
    !   emissivity          (n) 0 to 1
    !   surroundings        [K]
    !   power               (n) [W] out
    !   wall_temperature    (walls) [K], needed with walls
    !   wall_emissivity     (walls) 0 to 1, needed with walls
    !   wall_power          (walls) [W] out
    !   surroundings_power  [W] out
    !   error               [W] out: estimated error of power, root mean square over the spheres
    !   surroundings_error  [W] out: estimated error of surroundings_power
    subroutine heat_solve(heat, temperature, emissivity, surroundings, power, status, wall_temperature, wall_emissivity, &
                          wall_power, surroundings_power, error, surroundings_error)
        class(fibrad_heat), intent(inout) :: heat
        real(c_double), intent(in), contiguous, target :: temperature(:), emissivity(:)
        real(c_double), intent(in) :: surroundings
        real(c_double), intent(inout), contiguous, target :: power(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional, contiguous, target :: wall_temperature(:), wall_emissivity(:)
        real(c_double), intent(inout), optional :: wall_power(:)
        real(c_double), intent(inout), optional :: surroundings_power, error, surroundings_error
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
        if (present(wall_temperature)) sources%wall_temperature = c_loc(wall_temperature)
        if (present(wall_emissivity)) sources%wall_emissivity = c_loc(wall_emissivity)
        sources%surroundings = surroundings
        result%power = c_loc(power)
        result%wall_power = c_loc(walls)
        status = c_radiation_solve(heat%radiation, sources, result)
        if (status /= fibrad_ok) return
        if (present(wall_power)) wall_power = walls(1:heat%walls)
        if (present(surroundings_power)) surroundings_power = result%surroundings_power
        if (present(error)) error = hypot(result%error_patches, result%error_beams)
        if (present(surroundings_error)) surroundings_error = result%surroundings_error
    end subroutine heat_solve

    ! Net powers, and temperatures where they are unknown. Emissivities of spheres follow a law.
    !   temperature         (n) [K] in: NaN if unknown; out: all
    !   source              (n) [W] given off from inside by a sphere of unknown temperature
    !   law                 emissivities at temperatures
    !   emissivity          (n) in: to begin with, where temperatures are unknown; out: those of the solution
    !   surroundings        [K]
    !   power               (n) [W] out
    !   wall_temperature    (walls) [K] in: NaN if unknown; out: all; needed with walls
    !   wall_emissivity     (walls) 0 to 1, needed with walls
    !   wall_source         (walls) [W] given off by a wall of unknown temperature that is not insulated
    !   insulated           (walls) .true.: the wall sends back all that arrives
    !   wall_power          (walls) [W] out
    !   surroundings_power  [W] out
    !   temperature_error   (n) [K] out: estimated, 0 if the temperature was given
    !   conductivity        (n) [W/(m K)] of the solid, above 0; temperatures are then means of surfaces
    !   least, largest      (n) [K] out: of the surface of each sphere
    !   centre              (n) [K] out: in the centre of each sphere
    !   contacts            (2, m) ends of contacts: spheres from 1, or n plus a wall from 1
    !   conductance         (m) [W/K] of contacts
    !   conducted           (n) [W] out: part of power that comes through contacts
    subroutine heat_settle(heat, temperature, source, law, emissivity, surroundings, power, status, wall_temperature, &
                           wall_emissivity, wall_source, insulated, wall_power, surroundings_power, temperature_error, &
                           conductivity, least, largest, centre, contacts, conductance, conducted)
        class(fibrad_heat), intent(inout) :: heat
        real(c_double), intent(inout), contiguous, target :: temperature(:), emissivity(:), power(:)
        real(c_double), intent(in), contiguous, target :: source(:)
        procedure(fibrad_law) :: law
        real(c_double), intent(in) :: surroundings
        integer, intent(out) :: status
        real(c_double), intent(inout), optional, contiguous, target :: wall_temperature(:)
        real(c_double), intent(in), optional, contiguous, target :: wall_emissivity(:), wall_source(:)
        logical, intent(in), optional :: insulated(:)
        real(c_double), intent(inout), optional :: wall_power(:), surroundings_power
        real(c_double), intent(inout), optional, contiguous, target :: temperature_error(:)
        real(c_double), intent(in), optional, contiguous, target :: conductivity(:)
        real(c_double), intent(inout), optional, contiguous, target :: least(:), largest(:), centre(:)
        integer, intent(in), optional :: contacts(:, :)
        real(c_double), intent(in), optional, contiguous, target :: conductance(:)
        real(c_double), intent(inout), optional, contiguous, target :: conducted(:)
        integer(c_int32_t), allocatable, target :: ends(:, :)
        type(c_heat_sources) :: sources
        type(c_heat_result) :: result
        type(law_of_spheres), target :: follows
        real(c_double), target :: given(size(temperature))
        real(c_double), dimension(max(1, heat%walls)), target :: walls_given, walls_found, walls_power, walls_emit
        integer(c_signed_char), target :: closed(max(1, heat%walls))
        status = check_sizes(heat%spheres, size(temperature), size(emissivity), size(power), size(source))
        if (status == fibrad_ok) status = check_sizes(heat%walls, count_values(wall_temperature), &
                                                      count_values(wall_emissivity))
        if (status == fibrad_ok .and. present(wall_power)) status = check_sizes(heat%walls, size(wall_power))
        if (status == fibrad_ok .and. present(wall_source)) status = check_sizes(heat%walls, size(wall_source))
        if (status == fibrad_ok .and. present(insulated)) status = check_sizes(heat%walls, size(insulated))
        if (status == fibrad_ok .and. present(temperature_error)) status = check_sizes(heat%spheres, size(temperature_error))
        if (status == fibrad_ok .and. present(conductivity)) status = check_sizes(heat%spheres, size(conductivity))
        if (status == fibrad_ok .and. present(least)) status = check_sizes(heat%spheres, size(least))
        if (status == fibrad_ok .and. present(largest)) status = check_sizes(heat%spheres, size(largest))
        if (status == fibrad_ok .and. present(centre)) status = check_sizes(heat%spheres, size(centre))
        if (status == fibrad_ok .and. present(conducted)) status = check_sizes(heat%spheres, size(conducted))
        if (status /= fibrad_ok) return
        given = temperature
        sources%temperature = c_loc(given)
        sources%power = c_loc(source)
        sources%surroundings = surroundings
        if (present(wall_temperature)) walls_given(1:heat%walls) = wall_temperature
        if (present(wall_emissivity)) walls_emit(1:heat%walls) = wall_emissivity
        if (heat%walls > 0) sources%wall_temperature = c_loc(walls_given)
        if (present(wall_source)) sources%wall_power = c_loc(wall_source)
        if (present(insulated)) then
            closed(1:heat%walls) = merge(1_c_signed_char, 0_c_signed_char, insulated)
            sources%insulated = c_loc(closed)
        end if
        follows%law => law
        follows%n = heat%spheres
        result%power = c_loc(power)
        result%temperature = c_loc(temperature)
        result%wall_power = c_loc(walls_power)
        result%wall_temperature = c_loc(walls_found)
        if (present(temperature_error)) result%temperature_error = c_loc(temperature_error)
        if (present(conductivity)) sources%conductivity = c_loc(conductivity)
        if (present(least)) result%least_temperature = c_loc(least)
        if (present(largest)) result%largest_temperature = c_loc(largest)
        if (present(centre)) result%centre_temperature = c_loc(centre)
        if (present(conducted)) result%conducted = c_loc(conducted)
        if (present(contacts)) then
            status = check_sizes(2, size(contacts, 1))
            if (status == fibrad_ok .and. .not. present(conductance)) status = fibrad_e_argument
            if (status == fibrad_ok) status = check_sizes(size(contacts, 2), size(conductance))
            if (status == fibrad_ok .and. any(contacts < 1)) status = fibrad_e_argument
            if (status /= fibrad_ok) return
            ends = transpose(int(contacts, c_int32_t) - 1_c_int32_t)
            sources%contact_first = c_loc(ends(1, 1))
            sources%contact_second = c_loc(ends(1, 2))
            sources%conductance = c_loc(conductance)
            sources%contacts = int(size(conductance), c_int32_t)
        end if
        status = c_radiation_settle(heat%radiation, sources, c_funloc(follow_law), c_loc(follows), c_loc(emissivity), &
                                    c_loc(walls_emit), result)
        if (status /= fibrad_ok) return
        if (present(wall_temperature)) wall_temperature = walls_found(1:heat%walls)
        if (present(wall_power)) wall_power = walls_power(1:heat%walls)
        if (present(surroundings_power)) surroundings_power = result%surroundings_power
    end subroutine heat_settle

    ! What is absorbed of light from outside. Add it to powers.
    !   lights              what shines on the bed
    !   absorptivity        (n) 0 to 1
    !   absorbed            (n) [W] out: with all reflections
    !   absorbed_first      (n) [W] out: of the light that each sphere meets first
    !   wall_absorptivity   (walls) 0 to 1, needed with walls
    !   wall_absorbed       (walls) [W] out
    !   incident            [W] out: what all lights bring
    !   transmitted         [W] out: leaves without having met anything
    !   reflected           [W] out: leaves after reflections
    subroutine heat_shine(heat, lights, absorptivity, absorbed, absorbed_first, status, wall_absorptivity, wall_absorbed, &
                          incident, transmitted, reflected)
        class(fibrad_heat), intent(inout) :: heat
        type(fibrad_light), intent(in), contiguous, target :: lights(:)
        real(c_double), intent(in), contiguous, target :: absorptivity(:)
        real(c_double), intent(inout), contiguous, target :: absorbed(:), absorbed_first(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional, contiguous, target :: wall_absorptivity(:)
        real(c_double), intent(inout), optional :: wall_absorbed(:), incident, transmitted, reflected
        type(c_light_sources) :: sources
        type(c_light_result) :: result
        real(c_double), dimension(max(1, heat%walls)), target :: walls, walls_first
        status = check_sizes(heat%spheres, size(absorptivity), size(absorbed), size(absorbed_first))
        if (status == fibrad_ok) status = check_sizes(heat%walls, count_values(wall_absorptivity))
        if (status == fibrad_ok .and. present(wall_absorbed)) status = check_sizes(heat%walls, size(wall_absorbed))
        if (status /= fibrad_ok) return
        sources%light = c_loc(lights)
        sources%lights = size(lights)
        sources%absorptivity = c_loc(absorptivity)
        if (present(wall_absorptivity)) sources%wall_absorptivity = c_loc(wall_absorptivity)
        result%absorbed = c_loc(absorbed)
        result%absorbed_first = c_loc(absorbed_first)
        result%wall_absorbed = c_loc(walls)
        result%wall_absorbed_first = c_loc(walls_first)
        status = c_radiation_shine(heat%radiation, sources, result)
        if (status /= fibrad_ok) return
        if (present(wall_absorbed)) wall_absorbed = walls(1:heat%walls)
        if (present(incident)) incident = result%incident
        if (present(transmitted)) transmitted = result%transmitted
        if (present(reflected)) reflected = result%reflected
    end subroutine heat_shine

    ! Asks the law for emissivities of spheres. Emissivities of walls stay as they are.
    subroutine follow_law(context, temperature, wall_temperature, emissivity, wall_emissivity) bind(C)
        type(c_ptr), value :: context, temperature, wall_temperature, emissivity, wall_emissivity
        type(law_of_spheres), pointer :: follows
        real(c_double), pointer :: kelvins(:), shares(:)
        associate (unused => wall_temperature, stay => wall_emissivity)
        end associate
        call c_f_pointer(context, follows)
        call c_f_pointer(temperature, kelvins, [follows%n])
        call c_f_pointer(emissivity, shares, [follows%n])
        call follows%law(kelvins, shares)
    end subroutine follow_law

    ! Makes a bed that changes with time.
    !   method      fibrad_corrected, fibrad_patches or fibrad_factors_alone (fibrad_transient_method in fibrad_host.h);
    !               absent: fibrad_corrected
    !   tolerance   the error allowed in rows of exchange factors; absent: 0.03, or 0.01 by fibrad_factors_alone
    !   directions, points, patches: as in fibrad_heat; points absent: 128 by fibrad_corrected
    subroutine transient_new(transient, x, y, z, r, status, box, walls, method, tolerance, directions, points, patches, &
                             threads, fault, triangles)
        class(fibrad_transient), intent(inout) :: transient
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3), tolerance
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        type(fibrad_triangles), intent(in), optional :: triangles
        integer, intent(in), optional :: method, directions, points, patches, threads
        integer, intent(out), optional :: fault(2)
        type(walls_of_c), target :: mesh
        type(c_transient_config) :: config
        type(c_run) :: run
        call transient%free()
        call set_run(run, threads, fault)
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status == fibrad_ok) status = copy_triangles(triangles, mesh)
        if (status /= fibrad_ok) return
        if (present(method)) config%method = int(method, c_int)
        if (present(tolerance)) config%exchange%tolerance = tolerance
        if (present(directions)) config%heat%directions = int(directions, c_int32_t)
        if (present(points)) config%heat%points = int(points, c_int32_t)
        if (present(patches)) config%heat%patches = int(patches, c_int32_t)
        status = c_transient_new(transient%transient, scene_of(box, walls, mesh), spheres_of(x, y, z, r), config, run)
        call tell_fault(run%fault, size(x), fault)
        transient%spheres = size(x)
        transient%walls = count_walls(walls)
    end subroutine transient_new

    ! Goes on with the same spheres and walls at other positions. The arguments are those of `new`.
    subroutine transient_move(transient, x, y, z, r, status, box, walls, fault, triangles)
        class(fibrad_transient), intent(inout) :: transient
        real(c_double), intent(in), contiguous, target :: x(:), y(:), z(:), r(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional, contiguous, target :: walls(:)
        type(fibrad_triangles), intent(in), optional :: triangles
        integer, intent(out), optional :: fault(2)
        type(walls_of_c), target :: mesh
        type(c_fault) :: found
        type(c_scene_facts) :: facts
        if (present(fault)) fault = 0
        status = check_sizes(size(x), size(y), size(z), size(r))
        if (status == fibrad_ok) status = copy_triangles(triangles, mesh)
        if (status /= fibrad_ok) return
        status = c_transient_move(transient%transient, scene_of(box, walls, mesh), spheres_of(x, y, z, r))
        call c_transient_describe(transient%transient, facts, found)
        if (c_associated(transient%transient)) call tell_fault(found, size(x), fault)
    end subroutine transient_move

    ! Advances the temperatures of spheres by a span of time.
    !   temperature           (n) [K] in: at the beginning; out: at the end
    !   duration              [s] of the span
    !   capacity              (n) [J/K] heat capacities
    !   emissivity            (n) 0 to 1
    !   surroundings          [K] at the beginning
    !   source                (n) [W] heats each sphere from inside; absent: 0
    !   wall_temperature      (walls) [K] at the beginning, needed with walls
    !   wall_emissivity       (walls) 0 to 1, needed with walls
    !   wall_temperature_end  (walls) [K] at the end, linear in between; absent: constant
    !   surroundings_end      [K] at the end, linear in between; absent: constant
    !   step                  [s] all steps are equal and at most this long; absent: automatic steps
    !   tolerance             of automatic steps, relative error of a temperature; absent: 1e-4
    !   power                 (n) [W] out: net radiative power at the end
    !   wall_energy           (walls) [J] out: gained by radiation during the span
    !   surroundings_energy   [J] out: gained by radiation during the span
    !   steps                 out: steps taken
    subroutine transient_advance(transient, temperature, duration, capacity, emissivity, surroundings, status, source, &
                                 wall_temperature, wall_emissivity, wall_temperature_end, surroundings_end, step, &
                                 tolerance, power, wall_energy, surroundings_energy, steps, fault)
        class(fibrad_transient), intent(inout) :: transient
        real(c_double), intent(inout), contiguous, target :: temperature(:)
        real(c_double), intent(in) :: duration, surroundings
        real(c_double), intent(in), contiguous, target :: capacity(:), emissivity(:)
        integer, intent(out) :: status
        real(c_double), intent(in), optional, contiguous, target :: source(:), wall_temperature(:), wall_emissivity(:), &
                                                                    wall_temperature_end(:)
        real(c_double), intent(in), optional :: step, tolerance
        real(c_double), intent(in), optional, target :: surroundings_end
        real(c_double), intent(inout), optional, contiguous, target :: power(:), wall_energy(:)
        real(c_double), intent(inout), optional :: surroundings_energy
        integer, intent(out), optional :: steps, fault(2)
        type(c_heat_sources) :: sources
        type(c_span) :: span
        type(c_fault) :: found
        type(c_scene_facts) :: facts
        if (present(fault)) fault = 0
        status = check_sizes(transient%spheres, size(temperature), size(capacity), size(emissivity))
        if (status == fibrad_ok) status = check_sizes(transient%walls, count_values(wall_temperature), &
                                                      count_values(wall_emissivity))
        if (status == fibrad_ok .and. present(source)) status = check_sizes(transient%spheres, size(source))
        if (status == fibrad_ok .and. present(power)) status = check_sizes(transient%spheres, size(power))
        if (status == fibrad_ok .and. present(wall_energy)) status = check_sizes(transient%walls, size(wall_energy))
        if (status == fibrad_ok .and. present(wall_temperature_end)) status = check_sizes(transient%walls, &
                                                                                         size(wall_temperature_end))
        if (status /= fibrad_ok) return
        sources%emissivity = c_loc(emissivity)
        sources%surroundings = surroundings
        if (present(source)) sources%power = c_loc(source)
        if (present(wall_temperature)) sources%wall_temperature = c_loc(wall_temperature)
        if (present(wall_emissivity)) sources%wall_emissivity = c_loc(wall_emissivity)
        span%temperature = c_loc(temperature)
        span%capacity = c_loc(capacity)
        span%duration = duration
        if (present(wall_temperature_end)) span%wall_temperature = c_loc(wall_temperature_end)
        if (present(surroundings_end)) span%surroundings = c_loc(surroundings_end)
        if (present(step)) span%step = step
        if (present(tolerance)) span%tolerance = tolerance
        if (present(power)) span%power = c_loc(power)
        if (present(wall_energy)) span%wall_energy = c_loc(wall_energy)
        status = c_transient_advance(transient%transient, sources, span)
        call c_transient_describe(transient%transient, facts, found)
        if (status /= fibrad_ok .and. c_associated(transient%transient)) call tell_fault(found, size(temperature), fault)
        if (status /= fibrad_ok) return
        if (present(surroundings_energy)) surroundings_energy = span%surroundings_energy
        if (present(steps)) steps = int(span%steps)
    end subroutine transient_advance

    ! Returns the memory. `new` may be called again.
    subroutine transient_free(transient)
        class(fibrad_transient), intent(inout) :: transient
        call c_transient_free(transient%transient)
        transient%transient = c_null_ptr
        transient%spheres = 0
        transient%walls = 0
    end subroutine transient_free

    ! Returns the memory. `new` may be called again.
    subroutine heat_free(heat)
        class(fibrad_heat), intent(inout) :: heat
        call c_radiation_free(heat%radiation)
        heat%radiation = c_null_ptr
        heat%spheres = 0
        heat%walls = 0
    end subroutine heat_free

    ! The meaning of any status as one English phrase.
    function fibrad_status_text(status) result(text)
        integer, intent(in) :: status
        character(:), allocatable :: text
        text = text_of(c_status_text(int(status, c_int)))
    end function fibrad_status_text

    ! The version of the library.
    function fibrad_version() result(text)
        character(:), allocatable :: text
        text = text_of(c_version())
    end function fibrad_version

    ! Whether the structures of this module have the same sizes as those of the library.
    logical function fibrad_layouts_agree()
        integer :: k
        fibrad_layouts_agree = all([(c_host_sizeof(trim(c_names(k))//c_null_char) * 8 == c_bits(k), k=1, size(c_bits))])
    end function fibrad_layouts_agree

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

    ! fibrad_e_argument if arrays that belong together differ in size.
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
        if (present(walls)) count_walls = count(walls%kind /= kind_open)
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

    function scene_of(box, walls, mesh) result(config)
        real(c_double), intent(in), optional :: box(3)
        type(fibrad_wall), intent(in), optional :: walls(:)
        type(walls_of_c), intent(inout), target :: mesh
        type(c_scene_config) :: config
        if (present(box)) config%period = box
        if (present(walls)) then
            mesh%wall = pack(walls, walls%kind /= kind_open)
            mesh%opening = pack(walls%plane, walls%kind == kind_open)
            if (size(mesh%wall) > 0) config%wall = c_loc(mesh%wall)
            if (size(mesh%opening) > 0) config%opening = c_loc(mesh%opening)
            config%walls = size(mesh%wall, kind=c_int32_t)
            config%openings = size(mesh%opening, kind=c_int32_t)
        end if
        if (mesh%given%n > 0) config%triangles = c_loc(mesh%given)
    end function scene_of

    ! Copies triangles, with numbers from 0 as in C, for the time of a call.
    integer function copy_triangles(triangles, mesh)
        type(fibrad_triangles), intent(in), optional :: triangles
        type(walls_of_c), intent(inout), target :: mesh
        integer :: n
        copy_triangles = fibrad_ok
        if (.not. present(triangles)) return
        copy_triangles = fibrad_e_argument
        if (.not. (allocated(triangles%vertex) .and. allocated(triangles%corner) .and. allocated(triangles%front))) return
        n = size(triangles%front)
        if (size(triangles%vertex, 1) /= 3 .or. any(shape(triangles%corner) /= [3, n])) return
        mesh%vertex = triangles%vertex
        mesh%corner = triangles%corner - 1
        mesh%front = triangles%front - 1
        mesh%given%x = c_loc(mesh%vertex(1, 1))
        mesh%given%y = c_loc(mesh%vertex(2, 1))
        mesh%given%z = c_loc(mesh%vertex(3, 1))
        mesh%given%vertices = size(mesh%vertex, 2, kind=c_int32_t)
        mesh%given%corner = c_loc(mesh%corner)
        mesh%given%front = c_loc(mesh%front)
        mesh%given%n = int(n, c_int32_t)
        if (allocated(triangles%back)) then
            if (size(triangles%back) /= n) return
            mesh%back = triangles%back - 1
            mesh%given%back = c_loc(mesh%back)
        end if
        copy_triangles = fibrad_ok
    end function copy_triangles

    subroutine set_run(run, threads, fault)
        type(c_run), intent(inout) :: run
        integer, intent(in), optional :: threads
        integer, intent(out), optional :: fault(2)
        if (present(threads)) run%threads = int(threads, c_int)
        if (present(fault)) fault = 0
    end subroutine set_run

    ! The spheres at fault, counted from 1. In C the number of spheres stands for none.
    subroutine tell_fault(from, n, fault)
        type(c_fault), intent(in) :: from
        integer, intent(in) :: n
        integer, intent(out), optional :: fault(2)
        if (.not. present(fault)) return
        fault = [from%first, from%second] + 1
        where (fault > n) fault = 0
        if (from%triangle >= 0) fault = [-from%triangle - 1, 0]
    end subroutine tell_fault

    ! Copies factors of C into arrays with numbers from 1, and frees those of C.
    subroutine take_factors(found, factors)
        type(c_ptr), intent(in) :: found
        type(fibrad_factors), intent(inout) :: factors
        type(c_bed_factors), pointer :: bed
        integer(c_int64_t), pointer :: start(:)
        integer(c_int32_t), pointer :: col(:)
        integer :: n, walls
        call c_f_pointer(found, bed)
        n = bed%matrix%n
        walls = bed%matrix%walls
        call c_f_pointer(bed%matrix%start, start, [n + 1])
        call c_f_pointer(bed%matrix%col, col, [start(n + 1)])
        factors%start = start + 1
        factors%col = col + 1
        factors%f = reals(bed%matrix%f, start(n + 1))
        factors%escaped = reals(bed%matrix%escaped, int(n, c_int64_t))
        factors%beyond = reals(bed%matrix%beyond, int(n, c_int64_t))
        factors%error = reals(bed%matrix%error, int(n, c_int64_t))
        factors%wall = reshape(reals(bed%matrix%wall, int(n, c_int64_t) * walls), [walls, n])
        factors%wall_area = reals(bed%wall_area, int(walls, c_int64_t))
        if (c_associated(bed%matrix%wall_wall)) then
            factors%wall_wall = reshape(reals(bed%matrix%wall_wall, int(walls, c_int64_t)**2), [walls, walls])
            factors%wall_escaped = reals(bed%matrix%wall_escaped, int(walls, c_int64_t))
            factors%wall_error = reals(bed%matrix%wall_error, int(walls, c_int64_t))
        end if
        factors%directions = bed%directions
        factors%threads = bed%threads
        factors%seconds = bed%seconds
        factors%closure_error = bed%closure_error
        factors%reciprocity_error = bed%reciprocity_error
        call c_bed_free(bed)
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
