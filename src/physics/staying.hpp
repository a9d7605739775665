#pragma once
#include "talus/physics/path.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// How a block that does not get away ends. Walls hold it if the ground under it is steeper than phi, but does not
/// fall as steeply over the next two diameters downhill: then it is trapped. On other ground friction holds it, or
/// nearly so: it has stopped. docs/physics.md, "End of a trajectory".
End end_of_staying(const World& world, const Ground& ground, const Motion& motion, PatchIndex at, double diameter);

}  // namespace talus
