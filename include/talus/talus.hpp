#pragma once

/// The engine as a library: blocks on a terrain that the caller holds in memory. Nothing is read, written or printed,
/// and there are no threads: the caller may trace from as many as it likes.
///
///   Surface surface(heights);                            // heights: Raster<float>, row 0 in the south
///   Cover cover{{Ground{.theta_scale = 1.0}}, {}};       // the same ground everywhere
///   trace({surface, cover, {}, {}}, release, path);      // path: vertices, spans, and how the block ended
///
/// The same world and release give the same bits for every caller. docs/library.md
#include "talus/base/version.hpp"
#include "talus/physics/impact.hpp"
#include "talus/physics/trace.hpp"
#include "talus/terrain/surface.hpp"
