! fibrad.f90 - the structures and functions of fibrad_host.h in Fortran 2018, over libfibrad.so.
!
! Names, arguments, units, ranges and errors are those of the C functions: see fibrad_host.h and fibrad.h.
! An argument that is absent is NULL. The functions of C that return nothing are subroutines.
!
!   call fibrad_heat_sources_init(sources)
!   status = fibrad_bed_new(bed, spheres=spheres) ! type(c_ptr) :: bed
!   if (status == fibrad_ok) status = fibrad_bed_solve(bed, sources, result=result)
!   if (status /= fibrad_ok) print *, fibrad_text(fibrad_status_text(status))
!   call fibrad_bed_free(bed)
!
! Arrays in structures are pointers: spheres%x = c_loc(x), where x is a target. c_f_pointer makes arrays of results.
! Centres in an array (n, 3) are c_loc(at(1, 1)), c_loc(at(1, 2)), c_loc(at(1, 3)), in one of (3, n) they have stride 3.
! Numbers of spheres, walls and triangles count from 0, as in C.
!
! SPDX-License-Identifier: MIT
module fibrad
    use, intrinsic :: iso_c_binding
    implicit none

    integer, parameter :: fibrad_ok = 0, fibrad_e_argument = -1, fibrad_e_geometry = -6, fibrad_e_state = -8, &
                          fibrad_e_unsupported = -10, fibrad_e_memory = -11, fibrad_e_cancelled = -12, &
                          fibrad_e_unsolvable = -13, fibrad_e_back = -14, fibrad_e_sum = -15, &
                          fibrad_e_endless = -16, fibrad_e_file = -17
    integer(c_int), parameter :: fibrad_wall_plane = 1, fibrad_wall_cylinder = 2, fibrad_wall_mesh = 3 ! fibrad_wall%kind
    integer(c_int), parameter :: fibrad_spots_lens = 1, fibrad_spots_hertz = 2 ! fibrad_contact_rule%spots
    integer(c_int32_t), parameter :: fibrad_no_wall = -1 ! UINT32_MAX, of fibrad_triangles
    real(c_double), parameter :: fibrad_stefan_boltzmann = 5.670374419e-8_c_double

    ! ---- of C, by `make structures`
    type, bind(C) :: fibrad_stream
        type(c_ptr) :: slice = c_null_ptr, at = c_null_ptr, capacity = c_null_ptr
        integer(c_int32_t) :: slices = 0, points = 0
        real(c_double) :: inlet = 0
        type(c_ptr) :: gas = c_null_ptr
    end type fibrad_stream

    type, bind(C) :: fibrad_heat_sources
        type(c_ptr) :: temperature = c_null_ptr, emissivity = c_null_ptr, power = c_null_ptr, storage = c_null_ptr, &
            reference = c_null_ptr, wall_temperature = c_null_ptr, wall_emissivity = c_null_ptr, &
            wall_power = c_null_ptr, insulated = c_null_ptr
        real(c_double) :: surroundings = 0, sigma = 0, tolerance = 0
        integer(c_int32_t) :: sweeps_max = 0, no_errors = 0
        type(c_ptr) :: side_temperature = c_null_ptr, side_film = c_null_ptr, side_gas = c_null_ptr, &
            side_power = c_null_ptr, light = c_null_ptr, conductivity = c_null_ptr, absorbed = c_null_ptr, &
            contact_first = c_null_ptr, contact_second = c_null_ptr, conductance = c_null_ptr
        integer(c_int32_t) :: contacts = 0
        type(c_ptr) :: contact_temperature = c_null_ptr, film = c_null_ptr, gas = c_null_ptr, wall_film = c_null_ptr, &
            wall_gas = c_null_ptr, stream = c_null_ptr, contact_places = c_null_ptr
    end type fibrad_heat_sources

    type, bind(C) :: fibrad_plane
        integer(c_int) :: axis = 0, upper = 0
        real(c_double) :: at = 0
    end type fibrad_plane

    type, bind(C) :: fibrad_cylinder
        real(c_double) :: x = 0, y = 0, radius = 0
        integer(c_int) :: along = 0
    end type fibrad_cylinder

    type, bind(C) :: fibrad_wall
        integer(c_int) :: kind = 0
        type(fibrad_plane) :: plane
        type(fibrad_cylinder) :: cylinder
    end type fibrad_wall

    type, bind(C) :: fibrad_occupancy
        real(c_double) :: low(3) = 0, high(3) = 0
        integer(c_int32_t) :: cells(3) = 0
        integer(c_int) :: periodic(3) = 0
        type(c_ptr) :: mark = c_null_ptr
    end type fibrad_occupancy

    type, bind(C) :: fibrad_triangles
        type(c_ptr) :: x = c_null_ptr, y = c_null_ptr, z = c_null_ptr
        integer(c_int32_t) :: stride = 0, vertices = 0
        type(c_ptr) :: corner = c_null_ptr, front = c_null_ptr, back = c_null_ptr
        integer(c_int32_t) :: n = 0
        real(c_double) :: period(3) = 0
    end type fibrad_triangles

    type, bind(C) :: fibrad_scene_config
        integer(c_int) :: isa = 0
        real(c_double) :: period(3) = 0
        type(c_ptr) :: wall = c_null_ptr
        integer(c_int32_t) :: walls = 0
        type(c_ptr) :: opening = c_null_ptr
        integer(c_int32_t) :: openings = 0
        type(c_ptr) :: occupancy = c_null_ptr, triangles = c_null_ptr
    end type fibrad_scene_config

    type, bind(C) :: fibrad_spheres
        type(c_ptr) :: x = c_null_ptr, y = c_null_ptr, z = c_null_ptr, r = c_null_ptr
        integer(c_int32_t) :: n = 0, stride = 0, stride_r = 0
        type(c_ptr) :: id = c_null_ptr, clump = c_null_ptr
    end type fibrad_spheres

    type, bind(C) :: fibrad_fault
        integer(c_int32_t) :: first = 0, second = 0, triangle = 0, wall = 0
        integer(c_int) :: why = 0
    end type fibrad_fault

    type, bind(C) :: fibrad_run
        integer(c_int) :: threads = 0
        type(c_funptr) :: progress = c_null_funptr
        type(c_ptr) :: context = c_null_ptr
        type(fibrad_fault) :: fault
    end type fibrad_run

    type, bind(C) :: fibrad_scene_facts
        integer(c_int32_t) :: spheres = 0, walls = 0
        integer(c_int) :: isa = 0
        integer(c_int32_t) :: cells = 0
        real(c_double) :: radius_min = 0, radius_max = 0, overlap_max = 0
        integer(c_int32_t) :: overlap_pair(2) = 0, triangles = 0, clumps = 0, covered = 0, covered_sphere = 0, &
            parted = 0, parted_pair(2) = 0
    end type fibrad_scene_facts

    type, bind(C) :: fibrad_warning
        integer(c_int) :: code = 0
        integer(c_int32_t) :: first = 0, second = 0, wall = 0, count = 0
        real(c_double) :: value = 0, other = 0
    end type fibrad_warning

    type, bind(C) :: fibrad_beam_rule
        integer(c_int32_t) :: directions = 0, points = 0
        real(c_double) :: cutoff = 0, tolerance = 0
        integer(c_int64_t) :: turn = 0
        type(c_ptr) :: lines = c_null_ptr
        integer(c_int32_t) :: chords = 0
    end type fibrad_beam_rule

    type, bind(C) :: fibrad_cast_rule
        integer(c_int32_t) :: rays = 0
        integer(c_int) :: random = 0
        integer(c_int64_t) :: seed = 0
        real(c_double) :: cutoff = 0
    end type fibrad_cast_rule

    type, bind(C) :: fibrad_exchange_rule
        type(c_ptr) :: emissivity = c_null_ptr, wall_emissivity = c_null_ptr
        integer(c_int32_t) :: directions = 0, paths = 0
        integer(c_int64_t) :: seed = 0
        real(c_double) :: cutoff = 0, tolerance = 0
        type(c_ptr) :: node_emissivity = c_null_ptr
        real(c_double) :: open_error = 0
        type(c_ptr) :: conductivity = c_null_ptr, known = c_null_ptr
        real(c_double) :: known_paths = 0
    end type fibrad_exchange_rule

    type, bind(C) :: fibrad_bed_rule
        type(c_ptr) :: beam = c_null_ptr, cast = c_null_ptr, exchange = c_null_ptr, wanted = c_null_ptr
        integer(c_int) :: raw = 0
        real(c_double) :: drop = 0
        integer(c_int) :: walls = 0
        type(c_ptr) :: scratch = c_null_ptr
    end type fibrad_bed_rule

    type, bind(C) :: fibrad_factors
        integer(c_int32_t) :: n = 0, walls = 0
        type(c_ptr) :: start = c_null_ptr, col = c_null_ptr, f = c_null_ptr, escaped = c_null_ptr, &
            beyond = c_null_ptr, error = c_null_ptr, wall = c_null_ptr, wall_wall = c_null_ptr, &
            wall_escaped = c_null_ptr, wall_error = c_null_ptr
        real(c_double) :: wall_correction = 0, wall_closure = 0, changed = 0
        integer(c_int32_t) :: changed_row = 0
    end type fibrad_factors

    type, bind(C) :: fibrad_bed_matrix
        type(fibrad_factors) :: matrix
        type(fibrad_scene_facts) :: facts
        type(c_ptr) :: body = c_null_ptr, area = c_null_ptr, wall_area = c_null_ptr
        integer(c_int) :: threads = 0
        integer(c_int32_t) :: directions = 0
        integer(c_int64_t) :: fallbacks = 0, rays = 0
        real(c_double) :: seconds = 0, closure_error = 0, reciprocity_error = 0
    end type fibrad_bed_matrix

    type, bind(C) :: fibrad_wall_rule
        type(c_ptr) :: emissivity = c_null_ptr, wall_emissivity = c_null_ptr, node_emissivity = c_null_ptr, &
            conductivity = c_null_ptr
        integer(c_int32_t) :: paths = 0
        integer(c_int64_t) :: seed = 0
    end type fibrad_wall_rule

    type, bind(C) :: fibrad_wall_row
        real(c_double) :: wall(32) = 0, spheres = 0, escaped = 0, error = 0
        integer(c_int64_t) :: rays = 0, paths = 0
    end type fibrad_wall_row

    type, bind(C) :: fibrad_heat_config
        integer(c_int32_t) :: directions = 0, points = 0, patches = 0, parts = 0, wall_rays = 0
    end type fibrad_heat_config

    type, bind(C) :: fibrad_law
        type(c_funptr) :: follow = c_null_funptr
        type(c_ptr) :: context = c_null_ptr, emissivity = c_null_ptr, wall_emissivity = c_null_ptr
    end type fibrad_law

    type, bind(C) :: fibrad_heat_result
        type(c_ptr) :: power = c_null_ptr, wall_power = c_null_ptr
        real(c_double) :: surroundings_power = 0
        type(c_ptr) :: temperature = c_null_ptr, wall_temperature = c_null_ptr, power_error = c_null_ptr, &
            wall_error = c_null_ptr, temperature_error = c_null_ptr, wall_temperature_error = c_null_ptr
        real(c_double) :: error_patches = 0, error_beams = 0, residual = 0
        integer(c_int32_t) :: sweeps = 0
        type(c_ptr) :: wall_absorbed = c_null_ptr
        real(c_double) :: surroundings_error = 0
        type(c_ptr) :: wall_area = c_null_ptr, least_temperature = c_null_ptr, largest_temperature = c_null_ptr, &
            centre_temperature = c_null_ptr, surface_error = c_null_ptr, centre_error = c_null_ptr
        real(c_double) :: gas_power = 0, gas_error = 0
        type(c_ptr) :: convected = c_null_ptr, wall_convected = c_null_ptr, conducted = c_null_ptr, &
            wall_conducted = c_null_ptr, contact_flow = c_null_ptr, contact_error = c_null_ptr
    end type fibrad_heat_result

    type, bind(C) :: fibrad_light
        real(c_double) :: direction(3) = 0, flux = 0, half_angle = 0
        integer(c_int32_t) :: directions = 0
        integer(c_int) :: shape = 0
        real(c_double) :: centre(3) = 0, radius = 0, low(2) = 0, high(2) = 0
    end type fibrad_light

    type, bind(C) :: fibrad_light_sources
        type(c_ptr) :: light = c_null_ptr
        integer(c_int32_t) :: lights = 0
        type(c_ptr) :: absorptivity = c_null_ptr, wall_absorptivity = c_null_ptr
        real(c_double) :: tolerance = 0
    end type fibrad_light_sources

    type, bind(C) :: fibrad_light_result
        type(c_ptr) :: absorbed = c_null_ptr, absorbed_first = c_null_ptr, absorbed_error = c_null_ptr, &
            wall_absorbed = c_null_ptr, wall_absorbed_first = c_null_ptr, wall_absorbed_error = c_null_ptr
        real(c_double) :: incident = 0, transmitted = 0, reflected = 0, error = 0, error_patches = 0
        integer(c_int32_t) :: sweeps = 0, lights = 0
        type(c_ptr) :: patches = c_null_ptr
    end type fibrad_light_result

    type, bind(C) :: fibrad_store
        type(c_ptr) :: temperature = c_null_ptr, capacity = c_null_ptr
        integer(c_int32_t) :: rows = 0
        real(c_double) :: melting = 0, latent = 0, width = 0
    end type fibrad_store

    type, bind(C) :: fibrad_span
        type(c_ptr) :: temperature = c_null_ptr, capacity = c_null_ptr
        real(c_double) :: duration = 0
        type(c_ptr) :: store = c_null_ptr, store_of = c_null_ptr
        integer(c_int32_t) :: stores = 0
        type(c_ptr) :: melted = c_null_ptr, wall_capacity = c_null_ptr, wall_end = c_null_ptr, &
            wall_temperature = c_null_ptr, surroundings = c_null_ptr, gas = c_null_ptr, wall_gas = c_null_ptr, &
            side_temperature = c_null_ptr, side_gas = c_null_ptr, contact_temperature = c_null_ptr, inlet = c_null_ptr
        real(c_double) :: step = 0, tolerance = 0
        type(c_ptr) :: power = c_null_ptr, wall_power = c_null_ptr
        real(c_double) :: surroundings_power = 0
        type(c_ptr) :: wall_energy = c_null_ptr
        real(c_double) :: surroundings_energy = 0, gas_power = 0, gas_energy = 0, held_energy = 0
        type(c_ptr) :: convected_energy = c_null_ptr, contact_energy = c_null_ptr, side_energy = c_null_ptr, &
            side_end = c_null_ptr, stored = c_null_ptr, law = c_null_ptr
        type(c_funptr) :: observe = c_null_funptr
        type(c_ptr) :: context = c_null_ptr
        real(c_double) :: error = 0
        integer(c_int64_t) :: steps = 0, refused = 0, sweeps = 0, corrections = 0
    end type fibrad_span

    type, bind(C) :: fibrad_contact_rule
        integer(c_int) :: spots = 0
        real(c_double) :: scale = 0, gas_reach = 0, gas_jump = 0, gas_least = 0, wall = 0
        integer(c_int) :: gas_alone = 0
    end type fibrad_contact_rule

    type, bind(C) :: fibrad_contact_list
        integer(c_int32_t) :: n = 0
        type(c_ptr) :: first = c_null_ptr, second = c_null_ptr, distance = c_null_ptr, radius = c_null_ptr, &
            other = c_null_ptr, spot = c_null_ptr
    end type fibrad_contact_list

    interface
        function fibrad_status_text(status) bind(C)
            import
            integer(c_int), value :: status
            type(c_ptr) :: fibrad_status_text
        end function fibrad_status_text
        function fibrad_version() bind(C)
            import
            type(c_ptr) :: fibrad_version
        end function fibrad_version
        function fibrad_why_text(why) bind(C)
            import
            integer(c_int), value :: why
            type(c_ptr) :: fibrad_why_text
        end function fibrad_why_text
        function fibrad_node_emissivity(emissivity, conductivity) bind(C)
            import
            real(c_double), value :: emissivity
            real(c_double), value :: conductivity
            real(c_double) :: fibrad_node_emissivity
        end function fibrad_node_emissivity
        subroutine fibrad_heat_sources_init(sources) bind(C)
            import
            type(fibrad_heat_sources), intent(inout), optional :: sources
        end subroutine fibrad_heat_sources_init
        function fibrad_bed_new(bed, config, spheres, run) bind(C)
            import
            type(c_ptr), intent(out) :: bed
            type(fibrad_scene_config), intent(in), optional :: config
            type(fibrad_spheres), intent(in), optional :: spheres
            type(fibrad_run), intent(inout), optional :: run
            integer(c_int) :: fibrad_bed_new
        end function fibrad_bed_new
        function fibrad_bed_move(bed, config, spheres) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_scene_config), intent(in), optional :: config
            type(fibrad_spheres), intent(in), optional :: spheres
            integer(c_int) :: fibrad_bed_move
        end function fibrad_bed_move
        subroutine fibrad_bed_describe(bed, facts, fault) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_scene_facts), intent(inout), optional :: facts
            type(fibrad_fault), intent(inout), optional :: fault
        end subroutine fibrad_bed_describe
        function fibrad_bed_warnings(bed, warning) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_warning), intent(inout), optional :: warning(*)
            integer(c_int32_t) :: fibrad_bed_warnings
        end function fibrad_bed_warnings
        function fibrad_bed_bodies(bed, body) bind(C)
            import
            type(c_ptr), value :: bed
            integer(c_int32_t), intent(inout), optional :: body(*)
            integer(c_int32_t) :: fibrad_bed_bodies
        end function fibrad_bed_bodies
        function fibrad_bed_surfaces(bed, area, volume) bind(C)
            import
            type(c_ptr), value :: bed
            real(c_double), intent(inout), optional :: area(*)
            real(c_double), intent(inout), optional :: volume(*)
            integer(c_int) :: fibrad_bed_surfaces
        end function fibrad_bed_surfaces
        subroutine fibrad_bed_free(bed) bind(C)
            import
            type(c_ptr), value :: bed
        end subroutine fibrad_bed_free
        function fibrad_bed_factors(bed, rule, matrix) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_bed_rule), intent(in), optional :: rule
            type(c_ptr), intent(out) :: matrix
            integer(c_int) :: fibrad_bed_factors
        end function fibrad_bed_factors
        subroutine fibrad_bed_matrix_free(matrix) bind(C)
            import
            type(fibrad_bed_matrix), intent(inout), optional :: matrix
        end subroutine fibrad_bed_matrix_free
        function fibrad_view_factors(config, spheres, rule, run, matrix) bind(C)
            import
            type(fibrad_scene_config), intent(in), optional :: config
            type(fibrad_spheres), intent(in), optional :: spheres
            type(fibrad_bed_rule), intent(in), optional :: rule
            type(fibrad_run), intent(inout), optional :: run
            type(c_ptr), intent(out) :: matrix
            integer(c_int) :: fibrad_view_factors
        end function fibrad_view_factors
        function fibrad_bed_wall_area(bed, wall) bind(C)
            import
            type(c_ptr), value :: bed
            integer(c_int32_t), value :: wall
            real(c_double) :: fibrad_bed_wall_area
        end function fibrad_bed_wall_area
        function fibrad_bed_wall_row(bed, wall, rule, tolerance, row) bind(C)
            import
            type(c_ptr), value :: bed
            integer(c_int32_t), value :: wall
            type(fibrad_wall_rule), intent(in), optional :: rule
            real(c_double), value :: tolerance
            type(fibrad_wall_row), intent(inout), optional :: row
            integer(c_int) :: fibrad_bed_wall_row
        end function fibrad_bed_wall_row
        function fibrad_bed_beams(bed, config) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_heat_config), intent(in), optional :: config
            integer(c_int) :: fibrad_bed_beams
        end function fibrad_bed_beams
        function fibrad_bed_solve(bed, sources, law, result) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_heat_sources), intent(in), optional :: sources
            type(fibrad_law), intent(inout), optional :: law
            type(fibrad_heat_result), intent(inout), optional :: result
            integer(c_int) :: fibrad_bed_solve
        end function fibrad_bed_solve
        function fibrad_bed_sides(bed, flux, temperature) bind(C)
            import
            type(c_ptr), value :: bed
            real(c_double), intent(inout), optional :: flux(*)
            real(c_double), intent(inout), optional :: temperature(*)
            integer(c_int) :: fibrad_bed_sides
        end function fibrad_bed_sides
        function fibrad_bed_shine(bed, sources, result) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_light_sources), intent(in), optional :: sources
            type(fibrad_light_result), intent(inout), optional :: result
            integer(c_int) :: fibrad_bed_shine
        end function fibrad_bed_shine
        function fibrad_bed_advance(bed, sources, span) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_heat_sources), intent(in), optional :: sources
            type(fibrad_span), intent(inout), optional :: span
            integer(c_int) :: fibrad_bed_advance
        end function fibrad_bed_advance
        function fibrad_bed_contacts(bed, rule, list) bind(C)
            import
            type(c_ptr), value :: bed
            type(fibrad_contact_rule), intent(in), optional :: rule
            type(c_ptr), intent(out) :: list
            integer(c_int) :: fibrad_bed_contacts
        end function fibrad_bed_contacts
        function fibrad_contacts_conduct(list, rule, solid, gas, conductance) bind(C)
            import
            type(fibrad_contact_list), intent(in), optional :: list
            type(fibrad_contact_rule), intent(in), optional :: rule
            real(c_double), intent(in), optional :: solid(*)
            real(c_double), intent(in), optional :: gas(*)
            real(c_double), intent(inout), optional :: conductance(*)
            integer(c_int) :: fibrad_contacts_conduct
        end function fibrad_contacts_conduct
        function fibrad_heap_resize(context, block, size) bind(C)
            import
            type(c_ptr), value :: context
            type(c_ptr), value :: block
            integer(c_size_t), value :: size
            type(c_ptr) :: fibrad_heap_resize
        end function fibrad_heap_resize
        function fibrad_host_sizeof(name) bind(C)
            import
            character(kind=c_char), intent(in) :: name(*)
            integer(c_size_t) :: fibrad_host_sizeof
        end function fibrad_host_sizeof
    end interface
    ! ---- end of what `make structures` writes

contains

    ! The text at a pointer that fibrad_status_text, fibrad_why_text or fibrad_version has returned.
    function fibrad_text(pointer) result(text)
        type(c_ptr), intent(in) :: pointer
        character(:), allocatable :: text
        character(kind=c_char), pointer :: letters(:)
        integer :: n
        call c_f_pointer(pointer, letters, [1000])
        n = 0
        do while (letters(n + 1) /= c_null_char)
            n = n + 1
        end do
        allocate (character(n) :: text)
        text = transfer(letters(:n), text)
    end function fibrad_text
end module fibrad
