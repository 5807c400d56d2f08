! The orbit {J1, J8} of the impact microactuator (models/impact-microactuator.toml) for AUTO-07p: a boundary-value
! problem of its two segments side by side, each over a unit of time.
!     u(1:3): displacement, velocity and phase in stick, until the impact at the front
!     u(4:7): velocity of the frame, displacement, velocity and phase in positive slip, until the frame stops
!     par(1): V; par(2), par(3): durations of the segments

module microactuator
    implicit none
    double precision, parameter :: omega = 0.9189d0, m1 = 5, m2 = 1, stiffness = 1, damping = 0.04d0, gap = 1, &
        clearance = 0.5d0, restitution = 0.8d0, friction = 0.27d0 * 58.86d0, alpha = 1, pi = 3.14159265358979323846d0
contains
    ! Force of the frame on the impactor, and its derivatives by displacement, velocity, phase and voltage.
    subroutine force(x, v, phase, voltage, value, by)
        double precision, intent(in) :: x, v, phase, voltage
        double precision, intent(out) :: value, by(4)
        double precision :: pull

        pull = alpha * (voltage * sin(phase) / (gap - x))**2
        value = pull - damping * v - stiffness * x
        by = [2 * pull / (gap - x) - stiffness, -damping, &
              alpha * voltage**2 * sin(2 * phase) / (gap - x)**2, 2 * alpha * voltage * (sin(phase) / (gap - x))**2]
    end subroutine force
end module microactuator

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
    use microactuator
    implicit none
    integer, intent(in) :: ndim, icp(*), ijac
    double precision, intent(in) :: u(ndim), par(*)
    double precision, intent(out) :: f(ndim)
    double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
    double precision :: stick, slip, by_stick(4), by_slip(4)

    call force(u(1), u(2), u(3), par(1), stick, by_stick)
    call force(u(5), u(6), u(7), par(1), slip, by_slip)
    f(1:3) = [u(2), stick / m2, omega]
    f(4:7) = [-(slip + friction) / m1, u(6), slip / m2 + (slip + friction) / m1, omega]
    if (ijac == 2) then
        dfdp(1:ndim, 1:3) = 0
        dfdp(2, 1) = par(2) * by_stick(4) / m2
        dfdp(4, 1) = -par(3) * by_slip(4) / m1
        dfdp(6, 1) = par(3) * by_slip(4) * (1 / m2 + 1 / m1)
        dfdp(1:3, 2) = f(1:3)
        dfdp(4:7, 3) = f(4:7)
    end if
    f(1:3) = par(2) * f(1:3)
    f(4:7) = par(3) * f(4:7)
    if (ijac == 0) return

    dfdu = 0
    dfdu(1, 2) = par(2)
    dfdu(2, 1:3) = par(2) * by_stick(1:3) / m2
    dfdu(4, 5:7) = -par(3) * by_slip(1:3) / m1
    dfdu(5, 6) = par(3)
    dfdu(6, 5:7) = par(3) * by_slip(1:3) * (1 / m2 + 1 / m1)
end subroutine func

! The orbit comes from microactuator.dat, its parameters from microactuator.par.
subroutine stpnt(ndim, u, par, t)
    implicit none
    integer, intent(in) :: ndim
    double precision, intent(inout) :: u(ndim), par(*)
    double precision, intent(in) :: t

    open (unit=71, file='microactuator.par', status='old', action='read')
    read (71, *) par(1:3)
    close (71)
end subroutine stpnt

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
    use microactuator
    implicit none
    integer, intent(in) :: ndim, icp(*), nbc, ijac
    double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
    double precision, intent(out) :: fb(nbc)
    double precision, intent(inout) :: dbc(nbc, *)

    fb(1) = u1(1) - clearance
    ! impact
    fb(2) = u0(4) - m2 * (1 + restitution) / (m1 + m2) * u1(2)
    fb(3) = u0(5) - u1(1)
    fb(4) = u0(6) + restitution * u1(2)
    fb(5) = u0(7) - u1(3)
    ! the frame stops
    fb(6) = u1(4)
    fb(7) = u0(1) - u1(5)
    fb(8) = u0(2) - u1(6)
    fb(9) = u0(3) + pi - u1(7)
    if (ijac == 0) return

    dbc(1:nbc, 1:2 * ndim) = 0
    dbc(1, ndim + 1) = 1
    dbc(2, 4) = 1
    dbc(2, ndim + 2) = -m2 * (1 + restitution) / (m1 + m2)
    dbc(3, 5) = 1
    dbc(3, ndim + 1) = -1
    dbc(4, 6) = 1
    dbc(4, ndim + 2) = restitution
    dbc(5, 7) = 1
    dbc(5, ndim + 3) = -1
    dbc(6, ndim + 4) = 1
    dbc(7, 1) = 1
    dbc(7, ndim + 5) = -1
    dbc(8, 2) = 1
    dbc(8, ndim + 6) = -1
    dbc(9, 3) = 1
    dbc(9, ndim + 7) = -1
    if (ijac == 1) return
    dbc(1:nbc, 2 * ndim + 1:2 * ndim + 3) = 0
end subroutine bcnd

subroutine icnd
end subroutine icnd

subroutine fopt
end subroutine fopt

subroutine pvls
end subroutine pvls
