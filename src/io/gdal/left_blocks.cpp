#include "talus/io/gdal/left_blocks.hpp"

#include "csv_table.hpp"
#include "dataset.hpp"

namespace talus::io {
namespace {

std::vector<std::string> rows_of_exits(const std::string& file) {
  const Dataset dataset = open_dataset(file, GDAL_OF_VECTOR);
  OGRLayer* const layer = dataset->GetLayerCount() > 0 ? dataset->GetLayer(0) : nullptr;
  std::vector<std::string> blocks;
  if (layer == nullptr) return blocks;
  const int source = layer->GetLayerDefn()->GetFieldIndex("source"),
            block = layer->GetLayerDefn()->GetFieldIndex("block");
  if (source < 0 || block < 0) return blocks;
  while (const Feature feature{layer->GetNextFeature()})
    blocks.push_back(std::to_string(feature->GetFieldAsInteger64(source)) + ',' +
                     std::to_string(feature->GetFieldAsInteger64(block)));
  return blocks;
}

std::vector<std::string> rows_of_profile(const std::string& file) {
  const CsvTable table(file, {}, {"source", "block", "end"});
  std::vector<std::string> blocks;
  for (const CsvTable::Row& row : table.rows())
    if (table.text(row, "end") == "left") blocks.push_back(table.text(row, "source") + ',' + table.text(row, "block"));
  return blocks;
}

}  // namespace

std::optional<std::vector<std::string>> blocks_that_left(const std::filesystem::path& folder) {
  std::error_code none;
  for (const char* const name : {"exits.gpkg", "exits.fgb"})
    if (std::filesystem::exists(folder / name, none)) return rows_of_exits((folder / name).string());
  if (std::filesystem::exists(folder / "stops.csv", none)) return rows_of_profile((folder / "stops.csv").string());
  return std::nullopt;
}

}  // namespace talus::io
