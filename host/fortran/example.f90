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
    real(dp) :: position(n, 3), r(n), temperature(n), emissivity(n), power(n), floor_power(1), outside, lost, gained
    integer :: i, status, fault(2)
    type(fibrad_factors) :: factors
    type(fibrad_heat) :: heat

    do i = 0, n - 1
        position(i + 1, :) = 2.02_dp * radius * [mod(i, side), mod(i / side, side), i / side**2] + 1.01_dp * radius
    end do
    r = radius

    call fibrad_view_factors(position(:, 1), position(:, 2), position(:, 3), r, factors, status, &
                             walls=[fibrad_plane('zmin', 0.0_dp)], directions=100, fault=fault)
    call check('view factors')
    print '(a, i0, a, es8.1)', 'view factors: ', size(factors%f), ' entries, error ', maxval(factors%error)
    i = n / 2
    print '(a, f9.6)', 'sum of a row: ', &
        sum(factors%f(factors%start(i):factors%start(i + 1) - 1)) + factors%escaped(i) + sum(factors%wall(:, i))

    temperature = 1200
    emissivity = 0.8_dp
    gained = 0
    call heat%new(position(:, 1), position(:, 2), position(:, 3), r, status, walls=[fibrad_plane('zmin', 0.0_dp)])
    call check('heat')
    do i = 1, steps
        call heat%solve(temperature, emissivity, 300.0_dp, power, status, wall_temperature=[350.0_dp], &
                        wall_emissivity=[0.9_dp], wall_power=floor_power, surroundings_power=outside)
        call check('powers')
        temperature = temperature + step * power / heat_capacity
        gained = gained + step * (outside + floor_power(1))
        position(:, 3) = position(:, 3) + 1e-5_dp ! the bed is lifted a little
        call heat%move(position(:, 1), position(:, 2), position(:, 3), r, status, walls=[fibrad_plane('zmin', 0.0_dp)])
        call check('move')
    end do
    call heat%free()
    lost = heat_capacity * sum(1200 - temperature)
    print '(a, f0.6, a, f0.6, a)', 'lost by the spheres ', lost, ' J, gained by floor and surroundings ', gained, ' J'
    if (abs(lost - gained) > 1e-9_dp * lost) error stop 'energy is not kept'

contains
    subroutine check(what)
        character(*), intent(in) :: what
        if (status == fibrad_ok) return
        print '(3a, 2(1x, i0))', what, ': ', fibrad_status_text(status), fault
        error stop 1
    end subroutine check
end program example
