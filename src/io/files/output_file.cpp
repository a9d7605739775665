#include "talus/io/files/output_file.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include "input_files.hpp"
#include "io/gdal/dataset.hpp"
#include "io/gdal/geopackage.hpp"
#include "own_files.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

/// The GeoPackage that is to be replaced. Throws InputError if it is none.
Dataset earlier_file(const fs::path& path) {
  try {
    Dataset file = open_dataset(path.string(), GDAL_OF_VECTOR);
    if (EQUAL(file->GetDriverName(), "GPKG")) return file;
  } catch (const InputError&) {  // as of a file of another kind
  }
  throw InputError(path.string() +
                   ": --overwrite replaces only what talus has written, and this is no GeoPackage; "
                   "give a new name, or remove it yourself");
}

/// Layers and styles that were edited after Talus had written them: it writes dates of 1970, editors that of the
/// change.
std::vector<std::string> edited_layers(GDALDataset& file) {
  std::vector<std::string> edited;
  std::string sql = "SELECT table_name FROM gpkg_contents WHERE last_change NOT LIKE '1970-%'";
  if (file.GetLayerByName(kStylesTable) != nullptr)
    sql += std::string(" UNION SELECT '") + kStylesTable + "' FROM " + kStylesTable +
           " WHERE update_time NOT LIKE '1970-%'";
  OGRLayer* const rows = file.ExecuteSQL(sql.c_str(), nullptr, nullptr);
  if (rows == nullptr) return edited;
  while (const Feature row{rows->GetNextFeature()}) edited.emplace_back(row->GetFieldAsString(0));
  file.ReleaseResultSet(rows);
  return edited;
}

/// --overwrite replaces what the same command has written, no other file of the same name. Throws InputError.
/// @param layers  that the command writes
void refuse_foreign(const fs::path& path, const std::vector<std::string>& layers) {
  const Dataset file = earlier_file(path);
  std::vector<std::string> foreign;
  for (int i = 0; i < file->GetLayerCount(); ++i)
    if (const std::string name = file->GetLayer(i)->GetName();
        name != kStylesTable && std::ranges::find(layers, name) == layers.end())
      foreign.push_back(name);
  if (!foreign.empty())
    throw InputError(path.string() + ": --overwrite replaces only what the same command has written (" +
                     joined(layers) + "), and this file has other layers: " + listed(foreign) +
                     "; give a new name, or remove it yourself");
  if (const auto edited = edited_layers(*file); !edited.empty())
    throw InputError(path.string() + ": was written by another program, or was edited after talus had written it (" +
                     joined(edited) + "), and --overwrite would lose that; give a new name, or remove it yourself");
}

/// The place to which the file is written. Throws InputError if nothing can be written there.
fs::path checked(const fs::path& path, const std::string& extension, bool overwrite,
                 const std::vector<std::string>& layers) {
  const std::string name = path.string();
  if (path.extension() != extension || path.stem().empty())
    throw InputError(name + ": the file must end in " + extension + ", for example result" + extension);
  refuse_dangling_link(path);
  if (fs::is_directory(path)) throw InputError(name + ": is a folder; give the name of a file");
  if (fs::exists(path) && !overwrite)
    throw InputError(
        name +
        ": the file is there already; give a new name, or --overwrite where the command has it, or remove it first");
  if (fs::exists(path) && overwrite) refuse_foreign(path, layers);
  const fs::path place = behind_links(path);
  if (place.extension() != extension)
    throw InputError(name + ": is a link to " + place.string() + ", which must end in " + extension +
                     "; remove the link, or give another name");
  return place;
}

}  // namespace

OutputFile::OutputFile(const fs::path& path, const std::string& extension, bool overwrite,
                       const std::vector<std::string>& layers)
    : staged_(StagedPath::Kind::File, checked(path, extension, overwrite, layers), extension) {
  parents_.make(staged_.path().parent_path());
  refuse_unwritable(folder_written(path));
}

void OutputFile::protect(const fs::path& input) const {
  std::error_code none;
  for (const std::string& part : files_of_input(input.string()))
    if (fs::equivalent(part, staged_.path(), none))
      throw InputError(input.string() + ": is the file that --overwrite would replace; give another name");
}

void OutputFile::commit() {
  remove_beside(staged_.path());
  if (const std::error_code error = staged_.commit()) throw fs::filesystem_error("rename", staged_.path(), error);
}

}  // namespace talus::io
