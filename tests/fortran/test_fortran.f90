! test_fortran.f90 - the Fortran module against closed forms. SPDX-License-Identifier: MIT
program test_fortran
    use, intrinsic :: iso_c_binding, only: dp => c_double
    use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
    use fibrad
    implicit none
    real(dp), parameter :: pi = acos(-1.0_dp), sigma = fibrad_stefan_boltzmann
    real(dp), parameter :: touching = 7.5586818421612437949643298e-2_dp ! tests/data/pair_exact.csv
    integer :: failures = 0
    call factors_of_pairs()
    call walls_and_boxes()
    call open_sides()
    call meshes()
    call exchange_of_pairs()
    call spheres_that_conduct()
    call powers()
    call light_from_outside()
    call found_temperatures()
    call spheres_in_contact()
    call temperatures_in_time()
    call errors()
    if (failures > 0) error stop 'failures'
    print '(2a)', 'all is well with ', fibrad_version()

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

    subroutine factors_of_pairs()
        type(fibrad_factors) :: pair, other
        real(dp) :: at(3, 2)
        integer :: status
        call expect(fibrad_layouts_agree(), 'layouts')
        at = reshape([1.0_dp, 2.0_dp, 3.0_dp, 1.0_dp, 4.0_dp, 3.0_dp], [3, 2])
        call fibrad_view_factors(at(1, :), at(2, :), at(3, :), [1.0_dp, 1.0_dp], pair, status, directions=10000, threads=2)
        call expect(status == fibrad_ok, 'pair')
        call expect(all(pair%start == [1, 2, 3]) .and. all(pair%col == [2, 1]), 'rows count from 1')
        call expect(all(abs(pair%f - touching) < 1e-5_dp), 'touching spheres')
        call expect(all(abs(pair%f + pair%escaped - 1) < 1e-13_dp), 'closure')
        call expect(pair%directions == 10000 .and. pair%threads == 2 .and. pair%seconds > 0, 'facts')
        call fibrad_view_factors(at(1, :), at(2, :), at(3, :), [1.0_dp, 1.0_dp], other, status, tolerance=1e-3_dp, raw=.true.)
        call expect(other%directions < 10000 .and. all(other%error < 1e-3_dp), 'tolerance')
        call fibrad_view_factors(at(1, :), at(2, :), at(3, :), [1.0_dp, 1.0_dp], other, status, cutoff=1.5_dp)
        call expect(size(other%f) == 0 .and. all(other%beyond > 0), 'cutoff')
        call fibrad_view_factors(at(1, :0), at(2, :0), at(3, :0), at(1, :0), other, status)
        call expect(status == fibrad_ok .and. size(other%start) == 1 .and. size(other%f) == 0, 'no spheres')
    end subroutine factors_of_pairs

    subroutine walls_and_boxes()
        type(fibrad_factors) :: found
        integer :: status
        call fibrad_view_factors([0.0_dp], [0.0_dp], [3.0_dp], [1.0_dp], found, status, walls=[fibrad_plane('zmin', 0.0_dp)])
        call expect(near(found%wall(1, 1), 0.5_dp, 1e-12_dp), 'half of what it sends goes to the floor')
        call fibrad_view_factors([0.0_dp, 5.0_dp], [0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], [0.01_dp, 1.0_dp], found, status, &
            walls=[fibrad_cylinder(0.0_dp, 0.0_dp, 20.0_dp), fibrad_plane('zmax', 20.0_dp), fibrad_plane('zmin', -20.0_dp)])
        call expect(all(shape(found%wall) == [3, 2]) .and. near(found%wall_area(1), 1600 * pi, 1e-12_dp), 'tube')
        call expect(abs(found%wall(2, 1) - (1 - sqrt(0.5_dp)) / 2) < 2e-3_dp, 'disc under 45 degrees')
        call expect(abs(sum(found%wall(:, 2)) + sum(found%f(found%start(2):found%start(3) - 1)) - 1) < 1e-12_dp, 'closed')
        call expect(abs(found%wall_wall(1, 2) - (sqrt(8.0_dp) - 2)) < 1e-2_dp, 'from a disc to the tube')
        call expect(abs(20**2 * found%wall_wall(1, 2) - 1600 * found%wall_wall(2, 1)) < 1e-10_dp, 'reciprocal walls')
        call expect(maxval(abs(found%wall_escaped)) < 1e-12_dp .and. maxval(found%wall_error) < 1e-2_dp, 'nothing escapes')
        call fibrad_view_factors([0.0_dp], [2.0_dp], [3.0_dp], [1.0_dp], found, status, &
            walls=[fibrad_cylinder(2.0_dp, 3.0_dp, 20.0_dp, 'x'), fibrad_plane('xmax', 20.0_dp), fibrad_plane('xmin', -20.0_dp)])
        call expect(abs(found%wall(2, 1) - (1 - sqrt(0.5_dp)) / 2) < 2e-6_dp, 'a tube along x')
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, &
            walls=[fibrad_cylinder(0.0_dp, 0.0_dp, 20.0_dp, 'w'), fibrad_plane('xmax', 20.0_dp), fibrad_plane('xmin', -20.0_dp)])
        call expect(status == fibrad_e_argument, 'a tube along nothing')
        call fibrad_view_factors([0.5_dp], [0.5_dp], [0.5_dp], [0.5_dp], found, status, box=[1.0_dp, 1.0_dp, 1.0_dp])
        call expect(size(found%f) == 1 .and. abs(found%f(1) - 1) < 1e-2_dp, 'it sees its own images')
    end subroutine walls_and_boxes

    ! A cup as deep as it is wide, open above: a disc under 45 degrees is the surroundings'. Without it the cup is endless.
    subroutine open_sides()
        type(fibrad_factors) :: found
        type(fibrad_heat) :: heat
        real(dp) :: power(1), wall_power(2), outside, lids(3), closed, missed
        integer :: status, k
        type(fibrad_wall) :: cup(3), lid
        cup = [fibrad_plane('zmax', 10.0_dp, open=.true.), fibrad_cylinder(0.0_dp, 0.0_dp, 10.0_dp), &
               fibrad_plane('zmin', -10.0_dp)]
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, walls=cup)
        call expect(status == fibrad_ok .and. all(shape(found%wall) == [2, 1]), 'an open side is no wall')
        call expect(abs(found%escaped(1) - (1 - sqrt(0.5_dp)) / 2) < 2e-3_dp, 'a disc under 45 degrees is open')
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, walls=cup(2:3))
        call expect(status == fibrad_e_endless, 'a cup without a rim')
        call fibrad_view_factors([0.0_dp], [0.0_dp], [9.5_dp], [1.0_dp], found, status, walls=cup)
        call expect(status == fibrad_e_geometry, 'a sphere beyond the rim')
        lid = fibrad_plane('zmax', 10.0_dp)
        do k = 1, 2
            if (k == 1) call heat%new([0.0_dp], [0.0_dp], [3.0_dp], [1.0_dp], status, walls=cup)
            if (k == 2) call heat%new([0.0_dp], [0.0_dp], [3.0_dp], [1.0_dp], status, walls=[cup(2:3), lid])
            if (k == 1) call heat%solve([500.0_dp], [0.5_dp], 300.0_dp, power, status, wall_temperature=[600.0_dp, 700.0_dp], &
                                        wall_emissivity=[0.4_dp, 0.8_dp], wall_power=wall_power, surroundings_power=outside, &
                                        surroundings_error=missed)
            if (k == 1) closed = power(1)
            if (k == 2) call heat%solve([500.0_dp], [0.5_dp], 300.0_dp, power, status, &
                                        wall_temperature=[600.0_dp, 700.0_dp, 300.0_dp], &
                                        wall_emissivity=[0.4_dp, 0.8_dp, 1.0_dp], wall_power=lids)
            call expect(status == fibrad_ok, 'powers in a cup')
        end do
        call expect(near(power(1), closed, 1e-14_dp) .and. near(outside, lids(3), 1e-14_dp) .and. outside > 0, 'a black lid')
        call expect(missed > 0 .and. missed < 0.02_dp * outside, 'error of the surroundings')
        call expect(near(wall_power(1), lids(1), 1e-14_dp) .and. near(wall_power(2), lids(2), 1e-14_dp), 'the walls of the cup')
        call heat%free()
    end subroutine open_sides

    ! The box from -side to side about the origin: wall 1 is its floor, wall 2 all the rest. turned: about x, by an angle.
    function box_of(side, turned) result(box)
        real(dp), intent(in) :: side, turned
        type(fibrad_triangles) :: box
        integer, parameter :: quads(4, 6) = reshape( & ! fronts are outside
            [1, 3, 4, 2, 5, 6, 8, 7, 1, 2, 6, 5, 3, 7, 8, 4, 1, 5, 7, 3, 2, 4, 8, 6], [4, 6])
        integer :: k
        allocate (box%vertex(3, 8), box%corner(3, 12), box%front(12), box%back(12))
        do k = 0, 7
            box%vertex(:, k + 1) = side * (2 * [mod(k, 2), mod(k / 2, 2), k / 4] - 1)
            box%vertex(2:, k + 1) = [cos(turned) * box%vertex(2, k + 1) - sin(turned) * box%vertex(3, k + 1), &
                                     sin(turned) * box%vertex(2, k + 1) + cos(turned) * box%vertex(3, k + 1)]
        end do
        do k = 1, 6
            box%corner(:, 2 * k - 1) = quads([1, 2, 3], k)
            box%corner(:, 2 * k) = quads([1, 3, 4], k)
        end do
        box%front = 0
        box%back = 2
        box%back(1:2) = 1
    end function box_of

    subroutine meshes()
        type(fibrad_factors) :: found
        type(fibrad_heat) :: heat
        type(fibrad_triangles) :: box
        real(dp) :: power(1), wall_power(2), expected
        integer :: status, fault(2), turn
        box = box_of(2.0_dp, 0.0_dp)
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, walls=[fibrad_mesh(), fibrad_mesh()], &
                                 triangles=box)
        call expect(status == fibrad_ok .and. near(found%wall(1, 1), 1 / 6.0_dp, 5e-3_dp), 'a sixth goes to one side of a cube')
        call expect(abs(sum(found%wall(:, 1)) - 1) < 1e-12_dp .and. near(found%wall_area(2), 80.0_dp, 1e-12_dp), 'a closed mesh')
        call heat%new([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], status, walls=[fibrad_mesh(), fibrad_mesh()], triangles=box)
        expected = 4 * pi * 0.5_dp * sigma * (600.0_dp**4 - 1000.0_dp**4)
        do turn = 0, 1
            call heat%solve([1000.0_dp], [0.5_dp], 300.0_dp, power, status, wall_temperature=[600.0_dp, 600.0_dp], &
                            wall_emissivity=[1.0_dp, 1.0_dp], wall_power=wall_power)
            call expect(status == fibrad_ok .and. near(power(1), expected, 1e-9_dp), 'a sphere in a black cube of triangles')
            call expect(near(sum(wall_power), -expected, 1e-9_dp) .and. near(wall_power(1), -expected / 6, 0.02_dp), 'the floor')
            call heat%move([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], status, walls=[fibrad_mesh(), fibrad_mesh()], &
                           triangles=box_of(2.0_dp, 0.7_dp))
            call expect(status == fibrad_ok, 'a cube that turns')
        end do
        call heat%free()
        box%back = 0
        box%front = 2
        box%front(1) = 1
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, walls=[fibrad_mesh(), fibrad_mesh()], &
                                 triangles=box, fault=fault)
        call expect(status == fibrad_e_back .and. fault(1) < 0 .and. fault(1) >= -12 .and. fault(2) == 0, 'backs are seen')
        box%corner(2, 5) = 9
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, walls=[fibrad_mesh(), fibrad_mesh()], &
                                 triangles=box, fault=fault)
        call expect(status == fibrad_e_argument .and. all(fault == [-5, 0]), 'a corner that is none')
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, walls=[fibrad_mesh()], fault=fault)
        call expect(status == fibrad_e_argument, 'a mesh without triangles')
    end subroutine meshes

    subroutine exchange_of_pairs()
        type(fibrad_factors) :: found
        real(dp) :: e(2) = [0.5_dp, 0.9_dp]
        integer :: status
        call fibrad_exchange_factors([0.0_dp, 2.0_dp], [0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], [1.0_dp, 1.0_dp], e, found, &
                                     status, directions=2000, paths=2000)
        call expect(all(found%col == [1, 2, 1, 2]), 'each sees itself in the other')
        call expect(near(e(1) * found%f(2), e(2) * found%f(3), 1e-14_dp), 'reciprocity of exchange')
        call expect(abs(sum(found%f) + sum(found%escaped) - 2) < 1e-12_dp, 'closure of exchange')
        call fibrad_exchange_factors([0.0_dp], [0.0_dp], [3.0_dp], [1.0_dp], [0.5_dp], found, status, &
                                     walls=[fibrad_plane('zmin', 0.0_dp)], wall_emissivity=[1.0_dp])
        call expect(near(found%wall(1, 1), 0.5_dp, 1e-12_dp), 'a black floor absorbs what it gets')
    end subroutine exchange_of_pairs

    ! A lone sphere keeps what is even about it. In a simple cubic lattice of touching black spheres F_E is 1.2001, and
    ! .8006 at k* = 1 (test_solid.c).
    subroutine spheres_that_conduct()
        type(fibrad_factors) :: found
        real(dp) :: square(3, 1), error(3, 1), absorbed(1)
        real(dp), parameter :: none(1) = 0, half(1) = 0.5_dp, one(1) = 1, box(3) = 1
        integer :: status, fault(2)
        call fibrad_exchange_factors([0.0_dp, 2.0_dp], [none, none], [none, none], [one, one], [half, one], found, status, &
                                     directions=2000, paths=2000, k_star=[2.0_dp, 0.3_dp])
        call expect(status == fibrad_ok, 'exchange between nodes')
        call expect(all(found%node_emissivity > 0) .and. all(found%node_emissivity < [half, one]), 'emissivities of nodes')
        call expect(near(found%node_emissivity(1) * found%f(2), found%node_emissivity(2) * found%f(3), 1e-14_dp), &
                    'reciprocity between nodes')
        call expect(abs(sum(found%f) + sum(found%escaped) - 2) < 1e-12_dp, 'closure between nodes')
        call fibrad_exchange_factors(none, none, none, one, half, found, status, k_star=none, fault=fault)
        call expect(status == fibrad_e_argument .and. fault(1) == 1, 'a conductivity of 0')
        call expect(.not. allocated(found%node_emissivity), 'no nodes after an error')
        call fibrad_exchange_factors(none, none, none, one, half, found, status, k_star=[one, one])
        call expect(status == fibrad_e_argument, 'too many conductivities')
        call fibrad_displacements(none, none, none, half, one, square, status, box=box, paths=200000, error=error, &
                                  absorbed=absorbed)
        call expect(status == fibrad_ok .and. near(pi / 2 * sum(square) / 3, 1.2001_dp, 0.02_dp), 'F_E of a lattice')
        call expect(all(error > 0) .and. near(absorbed(1), 1.0_dp, 1e-3_dp), 'errors of F_E')
        call fibrad_displacements(none, none, none, half, one, square, status, box=box, paths=200000, k_star=one)
        call expect(status == fibrad_ok .and. near(pi / 2 * sum(square) / 3, 0.8006_dp, 0.03_dp), 'F_E of conducting spheres')
        call fibrad_displacements(none, none, none, half, one, square(:, :0), status)
        call expect(status == fibrad_e_argument, 'no room for displacements')
    end subroutine spheres_that_conduct

    ! A lone sphere above a floor takes its shadow, and its light falls on no one else.
    subroutine light_from_outside()
        type(fibrad_heat) :: heat
        type(fibrad_light) :: sun(1)
        real(dp) :: absorbed(1), first(1), floor(1), incident, through, back
        integer :: status
        sun(1) = fibrad_light(direction=[0.0_dp, 0.0_dp, -2.0_dp], flux=3.0_dp)
        call heat%new([0.0_dp], [0.0_dp], [1.0_dp], [0.5_dp], status, walls=[fibrad_plane('zmin', 0.0_dp)])
        call heat%shine(sun, [0.4_dp], absorbed, first, status, wall_absorptivity=[1.0_dp], wall_absorbed=floor, &
                        incident=incident, transmitted=through, reflected=back)
        call expect(status == fibrad_ok, 'light')
        call expect(near(first(1), 0.4_dp * 3 * pi / 4, 1e-12_dp), 'first hit of a sphere')
        call expect(near(absorbed(1), first(1), 1e-9_dp), 'a black floor sends nothing back')
        call expect(near(incident, 3.0_dp, 1e-12_dp) .and. abs(through) < 1e-12_dp, 'light on the box of the sphere')
        call expect(near(absorbed(1) + floor(1) + back, incident, 1e-12_dp), 'balance of light')
        sun(1)%direction = 0
        call heat%shine(sun, [0.4_dp], absorbed, first, status, wall_absorptivity=[1.0_dp])
        call expect(status == fibrad_e_argument, 'no direction')
        call heat%free()
    end subroutine light_from_outside

    subroutine powers()
        type(fibrad_heat) :: heat
        real(dp) :: power(1), none(0), plates(2), outside, error, expected
        integer :: status
        call heat%new([1.0_dp], [2.0_dp], [3.0_dp], [0.02_dp], status, threads=1)
        call heat%solve([900.0_dp], [0.3_dp], 400.0_dp, power, status, surroundings_power=outside, error=error)
        expected = 4 * pi * 0.02_dp**2 * 0.3_dp * sigma * (400.0_dp**4 - 900.0_dp**4)
        call expect(near(power(1), expected, 1e-9_dp) .and. near(outside, -expected, 1e-9_dp), 'one sphere')
        call expect(error >= 0 .and. error < 1e-3_dp * abs(expected), 'error')
        call heat%move([1.0_dp], [2.0_dp], [5.0_dp], [0.04_dp], status)
        call heat%solve([900.0_dp], [0.3_dp], 400.0_dp, power, status)
        call expect(near(power(1), 4 * expected, 1e-9_dp), 'one sphere, larger')
        call heat%new(none, none, none, none, status, box=[1.0_dp, 2.0_dp, 0.0_dp], &
                      walls=[fibrad_plane('zmin', 0.0_dp), fibrad_plane('zmax', 1.0_dp)])
        call heat%solve(none, none, 0.0_dp, none, status, wall_temperature=[1000.0_dp, 500.0_dp], &
                        wall_emissivity=[0.8_dp, 0.5_dp], wall_power=plates)
        expected = 2 * sigma * (1000.0_dp**4 - 500.0_dp**4) / (1 / 0.8_dp + 1 / 0.5_dp - 1)
        call expect(near(plates(2), expected, 1e-5_dp) .and. near(plates(1), -expected, 1e-5_dp), 'parallel plates')
        call heat%free()
        call heat%free()
        call heat%solve(none, none, 0.0_dp, none, status)
        call expect(status == fibrad_e_argument, 'freed')
    end subroutine powers

    ! e = T/2000, so that A e sigma (T^4 - 0) = source is T^5 = 2000 source/(A sigma).
    subroutine proportional(temperature, emissivity)
        real(dp), intent(in) :: temperature(:)
        real(dp), intent(inout) :: emissivity(:)
        where (temperature >= 0) emissivity = temperature / 2000
    end subroutine proportional

    subroutine found_temperatures()
        type(fibrad_heat) :: heat
        real(dp) :: unknown, t(2), e(2), power(2), error(2), walls(1), wall_power(1), outside, expected
        real(dp) :: least(2), largest(2), centre(2)
        integer :: status
        unknown = 0
        unknown = unknown / unknown
        call heat%new([0.0_dp, 100.0_dp], [0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], [0.01_dp, 0.01_dp], status)
        t = [unknown, 1000.0_dp]
        e = 0.5_dp
        call heat%settle(t, [10.0_dp, 0.0_dp], proportional, e, 0.0_dp, power, status, surroundings_power=outside, &
                         temperature_error=error)
        expected = (2000 * 10.0_dp / (4e-4_dp * pi * sigma))**0.2_dp
        call expect(status == fibrad_ok .and. near(t(1), expected, 1e-5_dp), 'a temperature is found')
        call expect(near(e(1), t(1) / 2000, 2e-5_dp) .and. near(e(2), 0.5_dp, 1e-14_dp), 'emissivities follow')
        call expect(near(power(1), -10.0_dp, 1e-9_dp) .and. near(outside, -sum(power), 1e-9_dp), 'powers given')
        call expect(error(1) < 1.0_dp .and. error(2) <= 0, 'errors of temperatures')
        t(1) = unknown
        call heat%settle(t, [10.0_dp, 0.0_dp], proportional, e, 0.0_dp, power, status, conductivity=[2.0_dp, 3.0_dp], &
                         least=least, largest=largest, centre=centre)
        call expect(status == fibrad_ok .and. near(t(1), expected, 1e-4_dp), 'a sphere that conducts')
        call expect(near(centre(1) - t(1), 10 / (8 * pi * 0.01_dp * 2), 1e-6_dp), 'the centre is hotter')
        call expect(all(least <= t) .and. all(t <= largest), 'a surface has no one temperature')
        call heat%new([0.0_dp, 1.0_dp], [0.0_dp, 0.0_dp], [0.5_dp, 0.5_dp], [0.3_dp, 0.3_dp], status, &
                      box=[2.0_dp, 2.0_dp, 0.0_dp], walls=[fibrad_plane('zmin', 0.0_dp)])
        t = unknown
        walls = unknown
        call heat%settle(t, [10.0_dp, 20.0_dp], proportional, e, 300.0_dp, power, status, wall_temperature=walls, &
                         wall_emissivity=[0.5_dp], insulated=[.true.], wall_power=wall_power, surroundings_power=outside)
        call expect(status == fibrad_ok .and. all(t > 300) .and. walls(1) > 300, 'above the surroundings')
        call expect(near(outside, 30.0_dp, 1e-9_dp) .and. abs(wall_power(1)) < 1e-9_dp, 'all goes to the surroundings')
    end subroutine found_temperatures

    ! Into 0 K: 1/T^3 grows by 3 A e sigma/C a second.
    subroutine temperatures_in_time()
        type(fibrad_transient) :: bed
        real(dp), parameter :: area = 4 * pi * 0.02_dp**2
        real(dp) :: t(1), power(1), floor(1), outside, expected
        integer :: status, steps, fault(2), method
        expected = (1200.0_dp**(-3) + 3 * area * 0.6_dp * sigma / 50 * 300)**(-1 / 3.0_dp)
        do method = fibrad_corrected, fibrad_factors_alone
            call bed%new([1.0_dp], [2.0_dp], [3.0_dp], [0.02_dp], status, method=method)
            t = 1200
            call bed%advance(t, 300.0_dp, [50.0_dp], [0.6_dp], 0.0_dp, status, power=power, surroundings_energy=outside, &
                             steps=steps)
            call expect(status == fibrad_ok .and. near(t(1), expected, 1e-4_dp) .and. steps > 5, 'cooling')
            call expect(near(outside, 50 * (1200 - t(1)), 1e-12_dp), 'energy')
            call expect(near(power(1), -area * 0.6_dp * sigma * t(1)**4, 1e-3_dp), 'power at the end')
        end do
        call bed%new([1.0_dp], [2.0_dp], [3.0_dp], [0.02_dp], status, walls=[fibrad_plane('zmin', 0.0_dp)])
        call bed%move([1.0_dp], [2.0_dp], [0.03_dp], [0.02_dp], status, walls=[fibrad_plane('zmin', 0.0_dp)])
        t = 600
        call bed%advance(t, 10.0_dp, [3.0_dp], [0.5_dp], 300.0_dp, status, source=[5.0_dp], wall_temperature=[500.0_dp], &
                         wall_emissivity=[0.7_dp], wall_temperature_end=[900.0_dp], step=1.0_dp, wall_energy=floor, &
                         surroundings_energy=outside, steps=steps)
        call expect(status == fibrad_ok .and. steps == 10, 'steps of a second')
        call expect(abs(3 * (t(1) - 600) + floor(1) + outside - 50) < 1e-9_dp, 'what is supplied is stored or goes out')
        t = -1
        call bed%advance(t, 10.0_dp, [3.0_dp], [0.5_dp], 300.0_dp, status, wall_temperature=[500.0_dp], &
                         wall_emissivity=[0.7_dp], fault=fault)
        call expect(status == fibrad_e_argument .and. all(fault == 1), 'no such temperature')
        t = 600
        call bed%advance(t, 10.0_dp, [3.0_dp], [0.5_dp], 300.0_dp, status, source=[-1e9_dp], wall_temperature=[500.0_dp], &
                         wall_emissivity=[0.7_dp])
        call expect(status == fibrad_e_unsolvable .and. all(t >= 600 .and. t <= 600), 'below zero')
        call bed%free()
        call bed%free()
    end subroutine temperatures_in_time

    ! A row of spheres without emission on a floor: all of the power goes through the contacts.
    subroutine spheres_in_contact()
        type(fibrad_heat) :: heat
        real(dp) :: temperature(3), emissivity(3), power(3), conducted(3), floor(1)
        integer :: status
        call heat%new([0.0_dp, 0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp, 0.0_dp], [1.0_dp, 3.0_dp, 5.0_dp], [1.0_dp, 1.0_dp, 1.0_dp], &
                      status, walls=[fibrad_plane('zmin', 0.0_dp)])
        call expect(status == fibrad_ok, 'a row of spheres')
        temperature = ieee_value(1.0_dp, ieee_quiet_nan)
        emissivity = 0
        floor = 400
        call heat%settle(temperature, [0.0_dp, 0.0_dp, 40.0_dp], constant, emissivity, 300.0_dp, power, status, &
                         wall_temperature=floor, wall_emissivity=[1.0_dp], contacts=reshape([1, 2, 2, 3, 4, 1], [2, 3]), &
                         conductance=[0.5_dp, 0.25_dp, 2.0_dp], conducted=conducted)
        call expect(status == fibrad_ok .and. all(abs(temperature - [420, 500, 660]) < 1e-6_dp), 'temperatures in contact')
        call expect(near(conducted(3), -40.0_dp, 1e-9_dp) .and. near(power(3), -40.0_dp, 1e-9_dp), 'powers in contact')
        temperature = ieee_value(1.0_dp, ieee_quiet_nan)
        call heat%settle(temperature, [0.0_dp, 0.0_dp, 40.0_dp], constant, emissivity, 300.0_dp, power, status, &
                         wall_temperature=floor, wall_emissivity=[1.0_dp], contacts=reshape([1, 2], [2, 1]))
        call expect(status == fibrad_e_argument, 'contacts without conductances')
        call heat%free()
    end subroutine spheres_in_contact

    ! Emissivities that do not change.
    subroutine constant(temperature, emissivity)
        real(dp), intent(in) :: temperature(:)
        real(dp), intent(inout) :: emissivity(:)
        if (size(temperature) == 0) emissivity = 0
    end subroutine constant

    subroutine errors()
        type(fibrad_factors) :: found
        type(fibrad_heat) :: heat
        real(dp) :: none(0), power(1)
        integer :: status, fault(2)
        call fibrad_view_factors([0.0_dp, 5.0_dp, 5.0_dp], [0.0_dp, 0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp, 0.0_dp], &
                                 [1.0_dp, 1.0_dp, 1.0_dp], found, status, fault=fault)
        call expect(status == fibrad_e_geometry .and. all(fault == [2, 3]), 'two spheres in one place')
        call expect(index(fibrad_status_text(status), 'same centre') > 0, 'text')
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, directions=7, fault=fault)
        call expect(status == fibrad_e_argument, 'directions')
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], none, found, status, fault=fault)
        call expect(status == fibrad_e_argument .and. all(fault == 0), 'sizes')
        call fibrad_view_factors([0.0_dp], [0.0_dp], [0.0_dp], [1.0_dp], found, status, walls=[fibrad_plane('floor', 0.0_dp)])
        call expect(status /= fibrad_ok, 'no such wall')
        call fibrad_exchange_factors([0.0_dp], [0.0_dp], [3.0_dp], [1.0_dp], [0.5_dp], found, status, &
                                     walls=[fibrad_plane('zmin', 0.0_dp)])
        call expect(status == fibrad_e_argument, 'the emissivity of a wall is missing')
        call fibrad_exchange_factors([0.0_dp], [0.0_dp], [3.0_dp], [1.0_dp], [1.5_dp], found, status, fault=fault)
        call expect(status == fibrad_e_argument .and. all(fault == 1), 'emissivity')
        call heat%new([0.0_dp], [0.0_dp], [3.0_dp], [-1.0_dp], status, fault=fault)
        call expect(status == fibrad_e_argument .and. all(fault == 1), 'radius')
        call heat%new([0.0_dp], [0.0_dp], [3.0_dp], [1.0_dp], status, walls=[fibrad_plane('zmin', 0.0_dp)])
        call heat%solve([300.0_dp], [1.0_dp], 300.0_dp, power, status)
        call expect(status == fibrad_e_argument, 'the temperature of a wall is missing')
        call heat%move([0.0_dp, 1.0_dp], [0.0_dp, 0.0_dp], [3.0_dp, 6.0_dp], [1.0_dp, 1.0_dp], status)
        call expect(status == fibrad_e_argument, 'another number of spheres')
        call heat%free()
    end subroutine errors
end program test_fortran
