#pragma once

#include "graze/layout/device_drawing.hpp"
#include "graze/model/model.hpp"
#include "graze/model/parameter_file.hpp"

namespace graze {

/// What remains of a drawn and etched device when its mass is a point: the numbers of Eq. (6.1), in units of the SI.
struct LumpedModel {
    double mass = 0;      ///< kg, with what moves of flexures
    double stiffness = 0; ///< N/m, of the bridge of the H
    double damping = 0;   ///< N s/m
    double area = 0;      ///< m^2, of plates without a fringe that attract as much (EquivalentPlates)
    double gap = 0;       ///< m, of these
    double stop = 0;      ///< m, to the contact, where the trench is narrowest

    // What they are made of.
    double plate_mass = 0;                                       ///< kg, of the H
    double stiff_trusses = 0;                                    ///< N/m, if nothing but beams would bend
    double rigid_mass = 0;                                       ///< N/m, if the bars of the H would not bend
    double electrode_film = 0, stop_films = 0, chamber_film = 0; ///< N s/m
    double closure = 0;                                          ///< m, until the electrodes touch
    double stress_per_travel = 0;                                ///< Pa/m, the greatest in a beam
    double squeeze = 0; ///< squeeze number of the electrodes' film at the natural frequency

    double frequency() const; ///< Hz, natural, without damping
    double damping_ratio() const;
    /// V, at which the electrodes snap together at rest, by Eq. (6.1): q = d/3, V^2 = 8 k d^3/(27 epsilon A).
    double pull_in() const;
};

constexpr double vacuum_permittivity = 8.8541878128e-12; ///< F/m

/// From the outlines that are drawn: mass and trusses by their areas, gaps by the distances of edges that face each
/// other, each with walls that recede from the drawn edge by bias and taper (EtchedWall).
/// @param stop_departure in um, by which the gap of the stops differs from the drawn one
/// @throws InputError where the etch leaves nothing of a part
LumpedModel lumped_model_of(const DeviceDrawing& drawing, const ProcessData& process,
                            const ProcessConditions& conditions, double stop_departure = 0);
/// @throws InputError with the place of the process in the file
LumpedModel lumped_model_of(const DeviceDrawing& drawing, const DeviceFile& file);
LumpedModel lumped_model_of(const DeviceFile& file);

/// Mean area of what an etch leaves of a polygon, between the surface and a depth, in um^2: each edge recedes, and
/// corners stay corners.
double etched_area(std::span<const GridPoint> corners, const EtchedWall& wall, double depth);

/// The model that a design file names. @throws InputError with the file's place
Model model_of(const DeviceFile& file);

/// Parameters m, f0, zeta, area, d and stop in a model's own units, in full precision.
/// @throws InputError when the model lacks one, or has it in a unit of another kind
ParameterFile parameters_of(const LumpedModel& lumped, const Model& model);

} // namespace graze
