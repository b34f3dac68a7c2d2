! test_fortran.f90 - the functions of C from Fortran, against closed forms. SPDX-License-Identifier: MIT
module laws
    use fibrad
    implicit none

contains
    ! 0.9 less a two-thousandth of the temperature.
    subroutine darken(context, temperature, wall_temperature, emissivity, wall_emissivity) bind(C)
        type(c_ptr), value :: context, wall_temperature, wall_emissivity
        real(c_double), intent(in) :: temperature(1)
        real(c_double), intent(inout) :: emissivity(1)
        if (c_associated(context) .or. c_associated(wall_temperature) .or. c_associated(wall_emissivity)) error stop
        if (temperature(1) > 0) emissivity = 0.9_c_double - temperature / 2000
    end subroutine darken
end module laws

program test_fortran
    use, intrinsic :: iso_c_binding, only: dp => c_double
    use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
    use fibrad
    use laws
    implicit none
    real(dp), parameter :: pi = acos(-1.0_dp), sigma = fibrad_stefan_boltzmann
    real(dp), parameter :: touching = 7.5586818421612437949643298e-2_dp ! tests/data/pair_exact.csv
    integer :: failures = 0
    call layouts()
    call factors_of_a_pair()
    call powers_within_a_mesh()
    call temperatures()
    call spheres_in_contact()
    call errors()
    if (failures > 0) error stop 'failures'
    print '(2a)', 'all is well with ', fibrad_text(fibrad_version())

contains
    subroutine expect(good, what)
        logical, intent(in) :: good
        character(*), intent(in) :: what
        if (good) return
        print '(2a)', 'FAILED: ', what
        failures = failures + 1
    end subroutine expect

    logical function near(value, expected, relative)
        real(dp), intent(in) :: value, expected, relative
        near = abs(value - expected) <= relative * abs(expected)
    end function near

    function spheres_at(at, r) result(spheres)
        real(dp), intent(in), target :: at(:, :), r(:)
        type(fibrad_spheres) :: spheres
        spheres = fibrad_spheres(c_loc(at(1, 1)), c_loc(at(2, 1)), c_loc(at(3, 1)), c_loc(r), size(r), 3)
    end function spheres_at

    subroutine layouts()
        type(fibrad_heat_sources) :: sources
        character(24), parameter :: names(8) = [character(24) :: 'scene_config', 'triangles', 'run', 'bed_matrix', &
                                                'heat_sources', 'heat_result', 'span', 'contact_list']
        integer, parameter :: bits(8) = &
            [storage_size(fibrad_scene_config()), storage_size(fibrad_triangles()), storage_size(fibrad_run()), &
             storage_size(fibrad_bed_matrix()), storage_size(fibrad_heat_sources()), storage_size(fibrad_heat_result()), &
             storage_size(fibrad_span()), storage_size(fibrad_contact_list())]
        integer :: k
        do k = 1, size(names)
            call expect(8 * fibrad_host_sizeof('fibrad_' // trim(names(k)) // c_null_char) == bits(k), names(k))
        end do
        call fibrad_heat_sources_init(sources)
        call expect(near(sources%sigma, sigma, 1e-15_dp) .and. ieee_is_nan(sources%surroundings), 'sources')
    end subroutine layouts

    subroutine factors_of_a_pair()
        real(dp), target :: at(3, 2) = reshape([1, 2, 3, 1, 4, 3], [3, 2]), r(2) = 1
        type(fibrad_beam_rule), target :: beam = fibrad_beam_rule(directions=10000)
        type(fibrad_bed_matrix), pointer :: pair
        type(fibrad_run) :: run = fibrad_run(threads=2)
        integer(c_int64_t), pointer :: start(:)
        integer(c_int32_t), pointer :: col(:)
        real(dp), pointer :: f(:), escaped(:)
        type(c_ptr) :: matrix
        call expect(fibrad_view_factors(spheres=spheres_at(at, r), rule=fibrad_bed_rule(beam=c_loc(beam)), run=run, &
                                        matrix=matrix) == fibrad_ok, 'pair')
        call c_f_pointer(matrix, pair)
        call c_f_pointer(pair%matrix%start, start, [3])
        call c_f_pointer(pair%matrix%col, col, [2])
        call c_f_pointer(pair%matrix%f, f, [2])
        call c_f_pointer(pair%matrix%escaped, escaped, [2])
        call expect(all(start == [0, 1, 2]) .and. all(col == [1, 0]), 'rows count from 0')
        call expect(all(abs(f - touching) < 1e-5_dp), 'touching spheres')
        call expect(all(abs(f + escaped - 1) < 1e-13_dp), 'closure')
        call expect(pair%directions == 10000 .and. pair%threads == 2 .and. pair%seconds > 0, 'facts')
        call fibrad_bed_matrix_free(pair)
    end subroutine factors_of_a_pair

    ! A sphere in a black tetrahedron, whose floor is wall 0.
    subroutine powers_within_a_mesh()
        real(dp), target :: corners(3, 4) = reshape([1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1], [3, 4]) * 4
        integer(c_int32_t), target :: corner(3, 4) = reshape([1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1], [3, 4])
        integer(c_int32_t), target :: front(4) = [0, 1, 1, 1]
        real(dp), target :: at(3, 1) = 0, r(1) = 1, kelvins(1) = 1000, e(1) = 0.5_dp, walls(2) = 600, black(2) = 1
        real(dp), target :: power(1), wall_power(2)
        real(dp) :: flux(8), expected
        type(fibrad_wall), target :: wall(2) = fibrad_wall(kind=fibrad_wall_mesh)
        type(fibrad_triangles), target :: triangles
        type(fibrad_heat_result) :: result
        type(c_ptr) :: bed
        triangles = fibrad_triangles(c_loc(corners(1, 1)), c_loc(corners(2, 1)), c_loc(corners(3, 1)), 3, 4, c_loc(corner), &
                                     c_loc(front), n=4)
        call expect(fibrad_bed_new(bed, fibrad_scene_config(wall=c_loc(wall), walls=2, triangles=c_loc(triangles)), &
                                   spheres_at(at, r)) == fibrad_ok, 'a mesh')
        call expect(fibrad_bed_beams(bed, fibrad_heat_config(directions=500)) == fibrad_ok, 'beams')
        result = fibrad_heat_result(power=c_loc(power), wall_power=c_loc(wall_power))
        call expect(fibrad_bed_solve(bed, fibrad_heat_sources(sigma=sigma, temperature=c_loc(kelvins), emissivity=c_loc(e), &
            wall_temperature=c_loc(walls), wall_emissivity=c_loc(black)), result=result) == fibrad_ok, 'powers')
        expected = 4 * pi * 0.5_dp * sigma * (600.0_dp**4 - 1000.0_dp**4)
        call expect(near(power(1), expected, 1e-9_dp), 'a sphere in a black mesh')
        call expect(near(wall_power(1), -expected / 4, 0.03_dp) .and. near(sum(wall_power), -expected, 1e-9_dp), 'its floor')
        call expect(fibrad_bed_sides(bed, flux) == fibrad_ok .and. any(flux > 0), 'fluxes of sides')
        call fibrad_bed_free(bed)
    end subroutine powers_within_a_mesh

    ! A sphere alone: A e sigma (T^4 - T0^4) = W, with an emissivity of its temperature; and 1/T^3 grows in the cold.
    subroutine temperatures()
        real(dp), target :: at(3, 1) = 0, r(1) = 0.5_dp, e(1) = 0.6_dp, unknown(1), watts(1) = 5e4_dp, found(1), power(1)
        real(dp), target :: capacity(1) = 1e5_dp, now(1) = 1200
        type(fibrad_law) :: law
        type(fibrad_heat_result) :: result
        type(fibrad_span) :: span
        type(c_ptr) :: bed
        unknown = ieee_value(unknown, ieee_quiet_nan)
        result = fibrad_heat_result(power=c_loc(power), temperature=c_loc(found))
        law = fibrad_law(follow=c_funloc(darken), emissivity=c_loc(e))
        call expect(fibrad_bed_new(bed, spheres=spheres_at(at, r)) == fibrad_ok, 'a bed without walls')
        call expect(fibrad_bed_solve(bed, fibrad_heat_sources(sigma=sigma, temperature=c_loc(unknown), power=c_loc(watts), &
            surroundings=300), law, result) == fibrad_ok, 'a law')
        call expect(near(pi * e(1) * sigma * (found(1)**4 - 300.0_dp**4), 5e4_dp, 1e-4_dp), 'a temperature that is found')
        call expect(near(e(1), 0.9_dp - found(1) / 2000, 1e-4_dp), 'the emissivity at this temperature')
        e = 0.6_dp
        span = fibrad_span(temperature=c_loc(now), capacity=c_loc(capacity), duration=300)
        call expect(fibrad_bed_advance(bed, fibrad_heat_sources(sigma=sigma, emissivity=c_loc(e)), span) == fibrad_ok, 'a span')
        call expect(near(now(1), (1200.0_dp**(-3) + 3 * pi * 0.6_dp * sigma / 1e5_dp * 300)**(-1 / 3.0_dp), 1e-4_dp), 'cooling')
        call expect(near(span%surroundings_energy, 1e5_dp * (1200 - now(1)), 1e-10_dp), 'energy')
        call fibrad_bed_free(bed)
    end subroutine temperatures

    ! Two spheres on a floor: a spot conducts 2 k a between spheres, and 4 k a to a wall.
    subroutine spheres_in_contact()
        real(dp), target :: at(3, 2) = reshape([0.0_dp, 0.0_dp, 0.99_dp, 0.0_dp, 0.0_dp, 2.97_dp], [3, 2]), r(2) = 1
        real(dp) :: conductance(2)
        type(fibrad_wall), target :: floor(1) = fibrad_wall(kind=fibrad_wall_plane, plane=fibrad_plane(axis=2))
        type(fibrad_contact_rule) :: rule = fibrad_contact_rule(spots=fibrad_spots_lens)
        type(fibrad_contact_list), pointer :: list
        type(c_ptr) :: bed, found
        call expect(fibrad_bed_new(bed, fibrad_scene_config(wall=c_loc(floor), walls=1), spheres_at(at, r)) == fibrad_ok, 'floor')
        call expect(fibrad_bed_contacts(bed, rule, found) == fibrad_ok, 'contacts')
        call c_f_pointer(found, list)
        call expect(list%n == 2, 'two contacts')
        call expect(fibrad_contacts_conduct(list, rule, [3.0_dp, 3.0_dp], conductance=conductance) == fibrad_ok, 'conduct')
        call expect(near(minval(conductance), 6 * sqrt(1 - 0.99_dp**2), 1e-9_dp), 'a spot between spheres')
        call expect(near(maxval(conductance), 12 * sqrt(1 - 0.99_dp**2), 1e-9_dp), 'a spot at a wall')
        call fibrad_bed_free(bed)
    end subroutine spheres_in_contact

    subroutine errors()
        real(dp), target :: at(3, 2) = 0, r(2) = 1
        type(fibrad_run) :: run
        type(c_ptr) :: bed
        call expect(fibrad_bed_new(bed, spheres=spheres_at(at, r), run=run) == fibrad_e_geometry, 'the same centre')
        call expect(run%fault%first == 0 .and. run%fault%second == 1 .and. .not. c_associated(bed), 'the spheres at fault')
        call expect(index(fibrad_text(fibrad_status_text(fibrad_e_geometry)), 'sphere') > 0, 'the text of a status')
        call expect(fibrad_bed_new(bed) == fibrad_e_argument, 'no spheres')
    end subroutine errors
end program test_fortran
