! example.f90 - a bed in a MFiX-like array of positions: view factors, then a time loop that keeps the energy.
!
! gfortran host/fortran/fibrad.f90 host/fortran/example.f90 -Lbuild -lfibrad -Wl,-rpath,build -o example
!
! SPDX-License-Identifier: MIT
program example
    use, intrinsic :: iso_c_binding, only: dp => c_double
    use fibrad
    implicit none
    integer, parameter :: side = 6, n = side**3, steps = 10
    real(dp), parameter :: radius = 0.005_dp, step = 2, pi = acos(-1.0_dp)
    real(dp), parameter :: heat_capacity = 4 * pi / 3 * radius**3 * 2500 * 800 ! J/K, of a sphere
    real(dp), target :: position(n, 3), r(n) = radius, temperature(n) = 1200, emissivity(n) = 0.8_dp, power(n)
    real(dp), target :: floor_temperature(1) = 350, floor_emissivity(1) = 0.9_dp, floor_power(1)
    real(dp) :: gained = 0, lost
    type(fibrad_wall), target :: floor(1)
    type(fibrad_scene_config) :: config
    type(fibrad_spheres) :: spheres
    type(fibrad_heat_sources) :: sources
    type(fibrad_heat_result) :: result
    type(fibrad_bed_matrix), pointer :: factors
    real(dp), pointer :: error(:)
    type(c_ptr) :: bed, matrix
    integer :: i

    do i = 0, n - 1
        position(i + 1, :) = 2.02_dp * radius * [mod(i, side), mod(i / side, side), i / side**2] + 1.01_dp * radius
    end do
    floor(1) = fibrad_wall(kind=fibrad_wall_plane, plane=fibrad_plane(axis=2, upper=0, at=0))
    config = fibrad_scene_config(wall=c_loc(floor), walls=1)
    spheres = fibrad_spheres(c_loc(position(1, 1)), c_loc(position(1, 2)), c_loc(position(1, 3)), c_loc(r), n)
    call check(fibrad_bed_new(bed, config, spheres))

    call check(fibrad_bed_factors(bed, matrix=matrix))
    call c_f_pointer(matrix, factors)
    call c_f_pointer(factors%matrix%error, error, [n])
    print '(a, i0, a, es8.1)', 'view factors along ', factors%directions, ' lines, error ', maxval(error)
    call fibrad_bed_matrix_free(factors)

    call fibrad_heat_sources_init(sources)
    sources%temperature = c_loc(temperature)
    sources%emissivity = c_loc(emissivity)
    sources%surroundings = 300
    sources%wall_temperature = c_loc(floor_temperature)
    sources%wall_emissivity = c_loc(floor_emissivity)
    result = fibrad_heat_result(power=c_loc(power), wall_power=c_loc(floor_power))
    do i = 1, steps
        call check(fibrad_bed_solve(bed, sources, result=result))
        temperature = temperature + step * power / heat_capacity
        gained = gained + step * (result%surroundings_power + floor_power(1))
        position(:, 3) = position(:, 3) + 1e-5_dp ! the bed is lifted a little
        call check(fibrad_bed_move(bed, config, spheres))
    end do
    call fibrad_bed_free(bed)
    lost = heat_capacity * sum(1200 - temperature)
    print '(a, f0.6, a, f0.6, a)', 'lost by the spheres ', lost, ' J, gained by floor and surroundings ', gained, ' J'
    if (abs(lost - gained) > 1e-9_dp * lost) error stop 'energy is not kept'

contains
    subroutine check(status)
        integer(c_int), intent(in) :: status
        if (status == fibrad_ok) return
        print '(a)', fibrad_text(fibrad_status_text(status))
        error stop 1
    end subroutine check
end program example
