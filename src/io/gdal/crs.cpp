#include "talus/io/gdal/crs.hpp"

#include <geodesic.h>
#include <proj.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dataset.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/input_access.hpp"

namespace talus::io {

namespace {

struct DropContext {
  void operator()(PJ_CONTEXT* c) const { proj_context_destroy(c); }
};
struct DropObject {
  void operator()(PJ* p) const { proj_destroy(p); }
};
struct DropArea {
  void operator()(PJ_AREA* a) const { proj_area_destroy(a); }
};
using Context = std::unique_ptr<PJ_CONTEXT, DropContext>;
using Object = std::unique_ptr<PJ, DropObject>;
using Area = std::unique_ptr<PJ_AREA, DropArea>;

Context make_context() {
  Context context(proj_context_create());
  if (!context) throw std::runtime_error("PROJ cannot be started");
  proj_log_level(context.get(), PJ_LOG_NONE);
  if (!network_is_allowed()) proj_context_set_enable_network(context.get(), 0);
  return context;
}

struct Axis {
  double unit = 0.0;  // in metres, or in radians
  std::string unit_name, direction;
};

// An axis of a system; without a name of its unit if there is none of this index.
Axis axis_of(PJ_CONTEXT* context, const PJ* system, int index) {
  const Object axes(proj_crs_get_coordinate_system(context, system));
  Axis axis;
  const char *name = nullptr, *direction = nullptr;
  if (axes && proj_cs_get_axis_info(context, axes.get(), index, nullptr, nullptr, &direction, &axis.unit, &name,
                                    nullptr, nullptr) != 0) {
    axis.unit_name = name == nullptr ? "" : name;
    axis.direction = direction == nullptr ? "" : direction;
  }
  return axis;
}

// The plane part, without a height system and without a transformation tied to it.
Object plane_part(PJ_CONTEXT* context, const std::string& wkt) {
  Object object(proj_create(context, without_heights(wkt).c_str()));
  for (int depth = 0; object && depth < 4; ++depth) {
    const PJ_TYPE type = proj_get_type(object.get());
    if (type == PJ_TYPE_COMPOUND_CRS)
      object.reset(proj_crs_get_sub_crs(context, object.get(), 0));
    else if (type == PJ_TYPE_BOUND_CRS)
      object.reset(proj_get_source_crs(context, object.get()));
    else
      break;
  }
  return object;
}

bool same_system(PJ_CONTEXT* context, const PJ* a, const PJ* b) {
  const Object p(proj_normalize_for_visualization(context, a)), q(proj_normalize_for_visualization(context, b));
  return p && q &&
         proj_is_equivalent_to_with_ctx(context, p.get(), q.get(), PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS) != 0;
}

/// Name of a local grid [small letters]; empty for any other system, and for a grid without a name.
std::string name_of_local_grid(const PJ* system) {
  const char* const given = proj_get_type(system) == PJ_TYPE_ENGINEERING_CRS ? proj_get_name(system) : nullptr;
  const std::string name = given == nullptr ? "" : lowercase(given);
  return name == "unknown" || name == "unnamed" ? "" : name;
}

/// Whether two systems are local grids with different names. PROJ compares only their axes and units.
bool are_other_grids(const PJ* a, const PJ* b) {
  const std::string name = name_of_local_grid(a), other = name_of_local_grid(b);
  return !name.empty() && !other.empty() && name != other;
}

// An operation between two systems for longitude/latitude or east/north; null if there is none.
Object make_operation(PJ_CONTEXT* context, const PJ* from, const PJ* to, PJ_AREA* area) {
  const Object operation(proj_create_crs_to_crs_from_pj(context, from, to, area, nullptr));
  return Object(operation ? proj_normalize_for_visualization(context, operation.get()) : nullptr);
}

// To longitude and latitude on WGS 84 [deg]; null for a system that is not tied to the earth.
Object to_degrees(PJ_CONTEXT* context, const PJ* system) {
  const Object degrees(proj_create(context, "OGC:CRS84"));
  return degrees ? make_operation(context, system, degrees.get(), nullptr) : Object();
}

PJ_COORD transformed(PJ* operation, double x, double y) {
  return proj_trans(operation, PJ_FWD, proj_coord(x, y, 0.0, HUGE_VAL));
}

bool is_metre(const Axis& axis) {
  return std::abs(axis.unit - 1.0) < 1e-9;
}

// "EPSG:32632" of the UTM zone of a place, as an example in messages.
std::string example_system(PJ_CONTEXT* context, const PJ* system, const MapExtent& e) {
  const Object operation = to_degrees(context, system);
  if (!operation) return "EPSG:32632";
  const PJ_COORD place = transformed(operation.get(), 0.5 * (e.west + e.east), 0.5 * (e.south + e.north));
  if (!(std::abs(place.xy.x) <= 180.0 && std::abs(place.xy.y) <= 84.0)) return "EPSG:32632";
  const int zone = std::min(60, static_cast<int>((place.xy.x + 180.0) / 6.0) + 1);
  return "EPSG:" + std::to_string((place.xy.y < 0.0 ? 32700 : 32600) + zone);
}

// Metres on the earth per metre of the map, towards east or north, whichever is farther from 1; 1 if not known.
double stretch(PJ_CONTEXT* context, const PJ* system, const MapExtent& e) {
  const Object operation = to_degrees(context, system);
  if (!operation) return 1.0;
  geod_geodesic earth;
  geod_init(&earth, 6378137.0, 1.0 / 298.257223563);
  const double x = 0.5 * (e.west + e.east), y = 0.5 * (e.south + e.north), half = 500.0;
  double worst = 1.0;
  for (const bool eastwards : {true, false}) {
    const double dx = eastwards ? half : 0.0, dy = half - dx;
    const PJ_COORD a = transformed(operation.get(), x - dx, y - dy), b = transformed(operation.get(), x + dx, y + dy);
    double metres = 0.0;
    geod_inverse(&earth, a.xy.y, a.xy.x, b.xy.y, b.xy.x, &metres, nullptr, nullptr);
    const double ratio = metres / (2.0 * half);
    if (std::abs(ratio - 1.0) > std::abs(worst - 1.0)) worst = ratio;
  }
  return worst;
}

// The axis of heights of a compound system, or of one with three axes.
Axis height_axis(PJ_CONTEXT* context, const std::string& wkt) {
  Object system(proj_create(context, wkt.c_str()));
  if (system && proj_get_type(system.get()) == PJ_TYPE_BOUND_CRS)
    system.reset(proj_get_source_crs(context, system.get()));
  if (!system) return {};
  if (proj_get_type(system.get()) != PJ_TYPE_COMPOUND_CRS) return axis_of(context, system.get(), 2);
  const Object heights(proj_crs_get_sub_crs(context, system.get(), 1));
  return heights ? axis_of(context, heights.get(), 0) : Axis{};
}

/// Option of GDAL's programs that says that a raster is in a local grid in metres, which has no code of EPSG.
std::string local_grid() {
  return "-a_srs " + shell_word(R"(LOCAL_CS["mine grid",UNIT["metre",1]])");
}

/// How to say which system a raster is in.
std::string naming(const std::string& path) {
  return "say which it is with " + edit_command(path, "-a_srs EPSG:...") +
         "; a local grid in metres, as of a mine, has no code: " + edit_command(path, local_grid());
}

/// How to bring a raster of a local grid into metres: no transformation leads out of such a grid.
std::string scaling(const std::string& path, const MapExtent& e, double unit_x, double unit_y) {
  std::string corners;
  for (const double place : {e.west * unit_x, e.north * unit_y, e.east * unit_x, e.south * unit_y})
    corners += " " + text_of(place);
  return "; multiply them with gdal_translate " + local_grid() + " -a_ullr" + corners + " " + shell_word(path) +
         " metres.tif, with the options -ot Float32 -scale 0 1 0 " + text_of(unit_x) +
         " as well if the heights are in this unit, too";
}

void check_heights(PJ_CONTEXT* context, const std::string& path, const std::string& wkt) {
  const Axis up = height_axis(context, wkt);
  if (!up.unit_name.empty() && !is_metre(up))
    throw InputError(
        path + ": heights are in '" + up.unit_name + "' (coordinate system " + crs_name(wkt) +
        "), must be metres: convert them with gdal_calc.py -A " + shell_word(path) + " --calc='A*" + text_of(up.unit) +
        "' --type=Float32 --outfile=metres.tif and give the result a system in metres with gdal_edit.py -a_srs");
  if (up.direction == "down")
    throw InputError(path + ": heights count downwards (coordinate system " + crs_name(wkt) +
                     "), must count upwards: turn them round with gdal_calc.py -A " + shell_word(path) +
                     " --calc='-A' --type=Float32 --outfile=heights.tif, and give the result a system of heights with "
                     "gdal_edit.py -a_srs; or only the latter, if they are heights");
}

}  // namespace

std::string extent_text(const MapExtent& e) {
  const auto metres = [](double value) { return text_of(std::round(value * 10.0) / 10.0); };
  return "east " + metres(e.west) + " to " + metres(e.east) + ", north " + metres(e.south) + " to " + metres(e.north);
}

std::string crs_name(const std::string& wkt) {
  const Context context = make_context();
  const Object object(proj_create(context.get(), wkt.c_str()));
  if (!object) return "unknown coordinate system";
  const char* name = proj_get_name(object.get());
  const char* authority = proj_get_id_auth_name(object.get(), 0);
  const char* code = proj_get_id_code(object.get(), 0);
  const std::string title = name == nullptr || *name == '\0' ? "unnamed coordinate system" : name;
  return authority == nullptr || code == nullptr ? title : std::string(authority) + ":" + code + " (" + title + ")";
}

std::string dem_system_note(const std::string& path, const std::string& dem_wkt) {
  return path + ": states no coordinate system: taken to be that of the DEM, " + crs_name(dem_wkt);
}

bool same_plane_system(const std::string& wkt, const std::string& other_wkt) {
  const Context context = make_context();
  const Object system = plane_part(context.get(), wkt), other = plane_part(context.get(), other_wkt);
  return system && other && same_system(context.get(), system.get(), other.get()) &&
         !are_other_grids(system.get(), other.get());
}

std::optional<std::string> check_metric(const std::string& path, const std::string& wkt, const MapExtent& extent) {
  if (wkt.empty())
    throw InputError(path + ": has no coordinate system, must be a projected one in metres: " + naming(path));
  const Context context = make_context();
  const Object system = plane_part(context.get(), wkt);
  if (!system) throw InputError(path + ": its coordinate system cannot be read by PROJ: " + naming(path));
  const PJ_TYPE type = proj_get_type(system.get());
  const std::string way_out = "; reproject it, for example with gdalwarp -t_srs " +
                              example_system(context.get(), system.get(), extent) + " -r cubicspline " +
                              shell_word(path) + " projected.tif, and -tr with the cell size of the survey";
  if (type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS)
    throw InputError(path + ": coordinates are in degrees (" + crs_name(wkt) +
                     "), must be metres of a projected coordinate system" + way_out);
  if (type != PJ_TYPE_PROJECTED_CRS && type != PJ_TYPE_ENGINEERING_CRS && type != PJ_TYPE_OTHER_CRS)
    throw InputError(path + ": " + crs_name(wkt) + " is not a projected coordinate system" + way_out);
  const Axis east = axis_of(context.get(), system.get(), 0), north = axis_of(context.get(), system.get(), 1);
  if (!is_metre(east) || !is_metre(north))
    throw InputError(path + ": coordinates are in '" + (is_metre(east) ? north : east).unit_name + "' (" +
                     crs_name(wkt) + "), must be metres" +
                     (type == PJ_TYPE_ENGINEERING_CRS ? scaling(path, extent, east.unit, north.unit) : way_out));
  if (east.direction == "west" || north.direction == "west")
    throw InputError(path + ": coordinates count to the " + east.direction + " and " + north.direction + " (" +
                     crs_name(wkt) +
                     "), must count to the east and north. In most such files they do so all the same, with a minus: "
                     "give the file a system that says so with gdal_edit.py -a_srs, as EPSG:5514 for EPSG:5513; else "
                     "reproject it with gdalwarp, and look in QGIS whether it lies where it should");
  check_heights(context.get(), path, wkt);

  const double ratio = stretch(context.get(), system.get(), extent);
  if (!(std::abs(ratio - 1.0) > 0.01)) return std::nullopt;
  const std::string text = path + ": " + crs_name(wkt) + " makes distances " + percent(std::abs(1.0 / ratio - 1.0)) +
                           (ratio < 1.0 ? " longer" : " shorter") + " than they are here, so that slopes are wrong";
  if (std::abs(ratio - 1.0) > 0.05) throw InputError(text + way_out);
  return text + way_out;
}

namespace {

// The area in degrees; without bounds if the map is not tied to the earth.
Area area_of(PJ_CONTEXT* context, const MapArea& map) {
  Area box(proj_area_create());
  const Object system = plane_part(context, map.wkt);
  const Object operation = system ? to_degrees(context, system.get()) : Object();
  if (!operation) return box;
  const PJ_COORD a = transformed(operation.get(), map.extent.west, map.extent.south);
  const PJ_COORD b = transformed(operation.get(), map.extent.east, map.extent.north);
  if (std::isfinite(a.xy.x) && std::isfinite(a.xy.y) && std::isfinite(b.xy.x) && std::isfinite(b.xy.y))
    proj_area_set_bbox(box.get(), a.xy.x, a.xy.y, b.xy.x, b.xy.y);
  return box;
}

}  // namespace

struct Transformer::Projection {
  Context context;
  Object operation;  // null: identity
  LayerName layer;
  std::string from_wkt, to_wkt;
  std::string other_grid;  // a warning; empty: none
  std::vector<Reprojection> used;
  std::size_t places = 0;

  void note_operation();
};

// Records the operation that PROJ used last: of several it uses the best one for each place.
void Transformer::Projection::note_operation() {
  const Object last(proj_trans_get_last_used_operation(operation.get()));
  PJ* const p = last ? last.get() : operation.get();
  const PJ_PROJ_INFO info = proj_pj_info(p);
  const char* name = proj_get_name(p);
  const std::string title = name != nullptr && *name != '\0' ? name
                            : info.description != nullptr    ? info.description
                                                             : "unnamed";
  if (std::any_of(used.begin(), used.end(), [&](const Reprojection& r) { return r.operation == title; })) return;
  const double accuracy = proj_coordoperation_get_accuracy(context.get(), p);
  used.push_back({layer.role, title, accuracy >= 0.0 ? std::optional(accuracy) : std::nullopt});
}

Transformer::Transformer(LayerName layer, const std::string& from_wkt, const std::string& to_wkt, const MapArea& map)
    : projection_(std::make_unique<Projection>()) {
  Projection& p = *projection_;
  p.context = make_context();
  p.layer = std::move(layer);
  p.from_wkt = from_wkt;
  p.to_wkt = to_wkt;
  const Object from = plane_part(p.context.get(), from_wkt), to = plane_part(p.context.get(), to_wkt);
  if (!from || !to)
    throw InputError(p.layer.path +
                     ": a coordinate system cannot be read by PROJ: say which it is with ogr2ogr -a_srs EPSG:...");
  if (same_system(p.context.get(), from.get(), to.get())) {
    const std::string& own = from_wkt == map.wkt ? to_wkt : from_wkt;  // a raster is looked up from the DEM
    if (are_other_grids(from.get(), to.get()))
      p.other_grid = p.layer.path + ": says the local grid '" + crs_name(own) + "', the DEM '" + crs_name(map.wkt) +
                     "': taken as the same grid";
    return;
  }
  const Area box = area_of(p.context.get(), map);
  p.operation = make_operation(p.context.get(), from.get(), to.get(), box.get());
  if (!p.operation)
    throw InputError(p.layer.path + ": there is no transformation from " + crs_name(from_wkt) + " to " +
                     crs_name(to_wkt) +
                     ": bring the layer into the system of the DEM first, with ogr2ogr -t_srs or gdalwarp -t_srs (a "
                     "local grid needs its shift and rotation: ogr2ogr -a_srs where the coordinates are those of the "
                     "DEM already)");
}

Transformer::~Transformer() = default;
Transformer::Transformer(Transformer&&) noexcept = default;

void Transformer::apply(double& x, double& y, const std::string& where) {
  Projection& p = *projection_;
  if (!p.operation) return;
  const PJ_COORD out = transformed(p.operation.get(), x, y);
  if (!std::isfinite(out.xy.x) || !std::isfinite(out.xy.y))
    throw InputError(where + ": the place (" + text_of(x) + ", " + text_of(y) + ") cannot be transformed from " +
                     crs_name(p.from_wkt) + " to " + crs_name(p.to_wkt) + ": is its coordinate system the right one?");
  if (p.places++ % 256 == 0) p.note_operation();
  x = out.xy.x;
  y = out.xy.y;
}

const std::vector<Reprojection>& Transformer::used() const {
  return projection_->used;
}

std::vector<std::string> Transformer::warnings(double cell) const {
  std::vector<std::string> lines;
  if (!projection_->other_grid.empty()) lines.push_back(projection_->other_grid);
  for (const Reprojection& r : used()) {
    if (r.accuracy_m && *r.accuracy_m <= 0.5 * cell) continue;
    lines.push_back(projection_->layer.path + ": brought from " + crs_name(projection_->from_wkt) + " to " +
                    crs_name(projection_->to_wkt) + " by '" + r.operation + "', " +
                    (r.accuracy_m ? "accurate to " + text_of(*r.accuracy_m) + " m only: worse than half a cell"
                                  : "of unknown accuracy") +
                    " (a grid of PROJ, package proj-data, may be missing)");
  }
  return lines;
}

}  // namespace talus::io
