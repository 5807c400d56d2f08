! The orbit {J5} of the impact microactuator (models/impact-microactuator.toml) for AUTO-07p: the frame rests and the
! impactor oscillates without contact. Displacement, velocity, and a nonlinear oscillator whose stable cycle is the
! cosine and sine of twice the voltage's phase. par(1): V; par(2): omega; the period is parameter 11.

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
    implicit none
    integer, intent(in) :: ndim, icp(*), ijac
    double precision, intent(in) :: u(ndim), par(*)
    double precision, intent(out) :: f(ndim)
    double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
    double precision, parameter :: damping = 0.04d0
    double precision :: r2, pull, omega

    omega = 2 * par(2)
    r2 = u(3)**2 + u(4)**2
    pull = par(1)**2 * (1 - u(3)) / 2 / (1 - u(1))**2 ! sin^2 of the phase from the cosine of its double
    f(1) = u(2)
    f(2) = pull - damping * u(2) - u(1)
    f(3) = u(3) * (1 - r2) - omega * u(4)
    f(4) = u(4) * (1 - r2) + omega * u(3)
    if (ijac == 0) return

    dfdu = 0
    dfdu(1, 2) = 1
    dfdu(2, 1) = 2 * pull / (1 - u(1)) - 1
    dfdu(2, 2) = -damping
    dfdu(2, 3) = -par(1)**2 / 2 / (1 - u(1))**2
    dfdu(3, 3) = 1 - r2 - 2 * u(3)**2
    dfdu(3, 4) = -2 * u(3) * u(4) - omega
    dfdu(4, 3) = -2 * u(3) * u(4) + omega
    dfdu(4, 4) = 1 - r2 - 2 * u(4)**2
    if (ijac == 1) return

    dfdp(1:ndim, 1:2) = 0
    dfdp(2, 1) = par(1) * (1 - u(3)) / (1 - u(1))**2
    dfdp(3, 2) = -2 * u(4)
    dfdp(4, 2) = 2 * u(3)
end subroutine func

! Without voltage the impactor is at rest.
subroutine stpnt(ndim, u, par, t)
    implicit none
    integer, intent(in) :: ndim
    double precision, intent(inout) :: u(ndim), par(*)
    double precision, intent(in) :: t
    double precision, parameter :: pi = 3.14159265358979323846d0

    par(1) = 0
    par(2) = 0.9189d0
    par(11) = pi / 0.9189d0
    u = [0d0, 0d0, cos(2 * pi * t), sin(2 * pi * t)]
end subroutine stpnt

subroutine bcnd
end subroutine bcnd

subroutine icnd
end subroutine icnd

subroutine fopt
end subroutine fopt

subroutine pvls
end subroutine pvls
