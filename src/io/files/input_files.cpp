#include "input_files.hpp"

#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>
#include <string_view>

#include "io/gdal/dataset.hpp"
#include "io/gdal/input_name.hpp"
#include "io/gdal/vrt_check.hpp"
#include "talus/base/error.hpp"
#include "talus/io/gdal/layer_name.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

/// Endings of the files of one name that are read together. GDAL does not list these.
struct Companions {
  std::string_view of;
  std::vector<std::string_view> ends;
};

const std::array<Companions, 9>& companions() {
  static const std::array<Companions, 9> list{{{".shp", {".dbf", ".shx", ".prj", ".cpg"}},
                                               {".shx", {".shp", ".dbf", ".prj", ".cpg"}},
                                               {".dbf", {".shp", ".shx", ".prj", ".cpg"}},
                                               {".tab", {".dat", ".map", ".id", ".ind", ".dbf"}},
                                               {".mif", {".mid"}},
                                               {".mid", {".mif"}},
                                               {".csv", {".csvt", ".prj"}},
                                               {".tsv", {".csvt", ".prj"}},
                                               {".bmp", {".wld", ".bpw", ".bmpw"}}}};
  return list;
}

std::string with_letters(std::string text, int (*change)(int)) {
  std::ranges::transform(text, text.begin(), [=](unsigned char c) { return static_cast<char>(change(c)); });
  return text;
}

bool is_there(const std::string& file) {
  VSIStatBufL status;
  return VSIStatExL(name_for_gdal(file).c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0;
}

/// Overviews and statistics, which programs that show a raster write beside it.
bool is_for_display(std::string_view file) {
  constexpr std::array<std::string_view, 4> kEnds{".ovr", ".rrd", ".stx", "/sta.adf"};
  return std::ranges::any_of(kEnds, [&](std::string_view end) { return file.ends_with(end); });
}

/// The files of a geodatabase, the only folder that is an input: it has no folders in it (`looked_up`).
std::vector<std::string> files_in_folder(const std::string& folder) {
  std::error_code none;
  std::vector<std::string> files;
  for (fs::directory_iterator entry(folder, none), end; entry != end; entry.increment(none))
    if (entry->is_regular_file(none)) files.push_back(entry->path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// The file with those beside it: with names in capitals if there is none in small letters.
std::vector<std::string> with_companions(const std::string& file) {
  std::vector<std::string> files{file};
  const std::size_t dot = std::min(file.rfind('.'), file.size());
  const std::string stem = file.substr(0, dot), end = with_letters(file.substr(dot), std::tolower);
  for (const Companions& known : companions())
    if (known.of == end)
      for (const std::string_view other : known.ends) {
        const std::string small(other), large = with_letters(small, std::toupper);
        if (is_there(stem + small))
          files.push_back(stem + small);
        else if (is_there(stem + large))
          files.push_back(stem + large);
      }
  for (const char* more : {".msk", "-wal", ".aux.xml"})  // a mask; what SQLite keeps beside the file; scale, nodata
    if (is_there(file + more)) files.push_back(file + more);
  std::vector<std::string> listed = files_of_raster(file);
  std::erase_if(listed, is_for_display);
  std::ranges::sort(listed);
  files.insert(files.end(), listed.begin(), listed.end());
  return files;
}

/// The file that a name stands for, as GDAL takes it: of a part of a file that file.
std::string file_behind(const std::string& name) {
  if (name.starts_with("/vsi")) return name;
  const InputName found = looked_up(name);
  if (!found.file.empty()) return found.file;
  const auto part = part_name(name);
  return part ? part->file : name;
}

std::vector<std::string> named_in_vrt(const std::string& file) {
  const InputName found = looked_up(file);
  if (!found.fault.empty() || found.file.empty()) return {};
  try {
    return files_of_vrt(file, found.file);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

std::vector<std::string> files_of_input(const std::string& name) {
  std::error_code none;
  const std::string file = file_behind(file_of_layer(name));
  if (fs::is_directory(file, none)) return files_in_folder(file);
  start_gdal();
  std::vector<std::string> heads{file}, files;
  for (std::string& named : named_in_vrt(file)) heads.push_back(std::move(named));
  std::set<std::string> seen;
  for (const std::string& head : heads)
    for (const std::string& part : with_companions(head))
      if (seen.insert(part).second) files.push_back(part);
  return files;
}

}  // namespace talus::io
