// Records with closed forms, as a simulation would write them: what the report's tests draw.
#pragma once

#include <string>
#include <vector>

#include "tenon/tests/scratch_folder.hpp"

namespace tenon {

/// The files of one record, in the order in which a report takes them; the scenery lies beside the first.
using SampleRecord = std::vector<std::string>;

/// A ball let fall from 1 m that keeps 0.8 of its speed at each impact and comes to rest at t = 4.064 s; its events, and the first impacts'
/// fast phases of 10 ms. `title` is the scene's name.
SampleRecord write_bouncing_ball(const ScratchFolder& folder, const std::string& title = "bouncing ball");

/// Five pendula of 1 m that pass their swing on, planar, with rods; small angles.
SampleRecord write_cradle(const ScratchFolder& folder);

/// A box with a quaternion and a sphere on a spring above a plane, spatial, for 60 s in 60,000 rows with one spike one row wide.
SampleRecord write_long_flight(const ScratchFolder& folder);

}  // namespace tenon
