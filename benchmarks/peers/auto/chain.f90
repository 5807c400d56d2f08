! The chain of benchmarks/chain.hpp without its walls, for AUTO-07p: displacements, velocities, and a nonlinear
! oscillator whose stable cycle is the cosine and sine of the force's phase. The period is parameter 11.

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
    implicit none
    integer, intent(in) :: ndim, icp(*), ijac
    double precision, intent(in) :: u(ndim), par(*)
    double precision, intent(out) :: f(ndim)
    double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
    double precision, parameter :: spring = 0.2d0, damping = 0.04d0, coupling = 1, cubic = 0.1d0, omega = 0.9d0
    integer :: n, i, c, s
    double precision :: r2

    n = (ndim - 2) / 2
    c = ndim - 1
    s = ndim
    do i = 1, n
        f(i) = u(n + i)
        f(n + i) = -(spring + 2 * coupling) * u(i) - damping * u(n + i) - cubic * u(i)**3
        if (i > 1) f(n + i) = f(n + i) + coupling * u(i - 1)
        if (i < n) f(n + i) = f(n + i) + coupling * u(i + 1)
    end do
    f(n + 1) = f(n + 1) + par(1) * u(c)
    r2 = u(c)**2 + u(s)**2
    f(c) = u(c) * (1 - r2) - omega * u(s)
    f(s) = u(s) * (1 - r2) + omega * u(c)
    if (ijac == 0) return

    dfdu = 0
    do i = 1, n
        dfdu(i, n + i) = 1
        dfdu(n + i, i) = -(spring + 2 * coupling) - 3 * cubic * u(i)**2
        dfdu(n + i, n + i) = -damping
        if (i > 1) dfdu(n + i, i - 1) = coupling
        if (i < n) dfdu(n + i, i + 1) = coupling
    end do
    dfdu(n + 1, c) = par(1)
    dfdu(c, c) = 1 - r2 - 2 * u(c)**2
    dfdu(c, s) = -2 * u(c) * u(s) - omega
    dfdu(s, c) = -2 * u(c) * u(s) + omega
    dfdu(s, s) = 1 - r2 - 2 * u(s)**2
    if (ijac == 1) return

    dfdp(1:ndim, 1) = 0
    dfdp(n + 1, 1) = u(c)
end subroutine func

! Without force the chain is at rest.
subroutine stpnt(ndim, u, par, t)
    implicit none
    integer, intent(in) :: ndim
    double precision, intent(inout) :: u(ndim), par(*)
    double precision, intent(in) :: t
    double precision, parameter :: pi = 3.14159265358979323846d0

    par(1) = 0
    par(11) = 2 * pi / 0.9d0
    u = 0
    u(ndim - 1) = cos(2 * pi * t)
    u(ndim) = sin(2 * pi * t)
end subroutine stpnt

subroutine bcnd
end subroutine bcnd

subroutine icnd
end subroutine icnd

subroutine fopt
end subroutine fopt

subroutine pvls
end subroutine pvls
