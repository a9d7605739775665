#include "vrt_check.hpp"

#include <cpl_minixml.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

#include "dataset.hpp"
#include "input_name.hpp"
#include "regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

constexpr int kDeepest = 8;          // VRTs in VRTs
constexpr std::size_t kHead = 4096;  // bytes in which GDAL looks for the mark of a VRT, and more [byte]
constexpr const char* kMark = "<VRTDataset";
constexpr const char* kAuxiliary = ".aux.xml";
constexpr std::string_view kOverviews = "overview_file";  // the key by which metadata name them

bool has_mark(const std::string& name) {
  return read_start(name, kHead).find(kMark) != std::string::npos;
}

/// A name in a VRT.
struct Source {
  std::string name;
  bool relative = false;  // to the folder of the VRT
};

/// The key of an entry of metadata, <MDI key="X_DATASET">, in small letters; empty if the node is none.
std::string key_of_entry(const CPLXMLNode& node) {
  return EQUAL(node.pszValue, "MDI") ? lowercase(CPLGetXMLValue(&node, "key", "")) : "";
}

bool names_source(const CPLXMLNode& node) {
  const std::string name = lowercase(node.pszValue), key = key_of_entry(node);
  constexpr std::array<std::string_view, 3> kOthers{"sourcedataset", "srcdatasource", "dempath"};
  constexpr std::array<std::string_view, 3> kEntries{"x_dataset", "y_dataset", kOverviews};  // arrays of a warped VRT
  return name.ends_with("filename") || std::ranges::count(kOthers, std::string_view(name)) > 0 ||
         std::ranges::count(kEntries, std::string_view(key)) > 0;
}

/// The elements and attributes of a text in XML; none if GDAL cannot read it.
class XmlNodes {
 public:
  explicit XmlNodes(const std::string& text) : tree_(CPLParseXMLString(text.c_str())) {
    std::vector<const CPLXMLNode*> left;
    if (tree_) left.push_back(tree_.get());
    while (!left.empty()) {
      const CPLXMLNode* const node = left.back();
      left.pop_back();
      if (node->psNext != nullptr) left.push_back(node->psNext);
      if (node->psChild != nullptr) left.push_back(node->psChild);
      if (node->eType == CXT_Element || node->eType == CXT_Attribute) nodes_.push_back(node);
    }
  }

  auto begin() const { return nodes_.begin(); }
  auto end() const { return nodes_.end(); }

 private:
  const GdalMessages quiet_;
  const CPLXMLTreeCloser tree_;
  std::vector<const CPLXMLNode*> nodes_;
};

/// Throws InputError if a VRT asks for Python, for SQL (which could write a file), or for sources in another folder.
void refuse_programs(const std::string& vrt, const CPLXMLNode& node, const std::string& value) {
  if (EQUAL(node.pszValue, "PixelFunctionLanguage") && EQUAL(value.c_str(), "Python"))
    throw InputError(vrt +
                     ": has a pixel function in Python, which is never run: write it to a raster first, with "
                     "gdal_translate");
  const char* const option = EQUAL(node.pszValue, "OOI") ? CPLGetXMLValue(&node, "key", "") : "";
  if (EQUAL(option, "PRELUDE_STATEMENTS") || EQUAL(option, "ROOT_PATH"))
    throw InputError(vrt + ": has the open option " + option + ", which is never followed: remove it from the VRT");
}

/// The names of all files in the text of a VRT.
std::vector<Source> sources_in(const std::string& vrt, const std::string& text) {
  std::vector<Source> sources;
  for (const CPLXMLNode* const node : XmlNodes(text)) {
    const std::string value = CPLGetXMLValue(node, "", "");
    refuse_programs(vrt, *node, value);
    if (names_source(*node) && !value.empty())
      sources.push_back({value, std::atoi(CPLGetXMLValue(node, "relativeToVRT", "0")) != 0});
  }
  return sources;
}

/// Whether the file is there. Throws InputError if it is no regular one: it would be waited for.
bool is_regular_if_there(const std::string& file) {
  if (const auto fault = fault_of_file(file)) throw InputError(file + ": " + *fault);
  const GdalMessages quiet;
  VSIStatBufL status;
  return VSIStatExL(file.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0;
}

/// The text of a VRT or an .aux.xml, which GDAL reads whole.
std::string whole_text(const std::string& name) {
  std::string text = read_start(name, kMostVrt);
  if (text.size() > kMostVrt)
    throw InputError(name + ": has more than " + std::to_string(kMostVrt >> 20U) + " MB, must be smaller: " +
                     (name.ends_with(kAuxiliary) ? "take its histograms and tables out"
                                                 : "write it to a raster first, with gdal_translate"));
  return text;
}

/// Throws InputError if an .aux.xml names the file of the overviews, which GDAL would open unchecked.
void check_auxiliary(const std::string& file) {
  if (!is_regular_if_there(file)) return;
  for (const CPLXMLNode* const node : XmlNodes(whole_text(file)))
    if (key_of_entry(*node) == kOverviews)
      throw InputError(file + ": names '" + CPLGetXMLValue(node, "", "") +
                       "' as OVERVIEW_FILE, must name no other file: remove this entry");
}

/// A relative name in the folder of a VRT. Names of GDAL's files keep their "//".
std::string in_folder(const fs::path& folder, const std::string& name) {
  const std::string whole = (folder / name).string();
  return whole.starts_with("/vsi") ? whole : fs::path(whole).lexically_normal().string();
}

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path way = file.lexically_relative(folder);
  return !way.empty() && *way.begin() != "..";
}

/// A raster with all that it names: a VRT, or one beside which a VRT lies.
class VrtCheck {
 public:
  VrtCheck(const std::string& name, const std::string& file) : name_(name), folders_(allowed_folders()) {
    folders_.push_back(fs::absolute(file).lexically_normal().parent_path());
    check(name.starts_with("/vsi") ? name : file, 0);
  }

  /// The files that it names.
  const std::set<std::string>& files() const { return files_; }

 private:
  void check(const std::string& name, int depth) {
    for (const char* const end : {".ovr", ".msk"})  // GDAL opens them without being asked
      if (is_regular_if_there(name + end)) check(name + end, depth + 1);
    check_auxiliary(name + kAuxiliary);
    if (!has_mark(name)) return;
    if (depth > kDeepest)
      throw InputError(name_ + ": VRTs in VRTs, more than " + std::to_string(kDeepest) +
                       " deep: does one name itself?");
    const std::string text = whole_text(name);
    std::error_code none;  // GDAL looks beside what a link stands for
    const fs::path real = name.starts_with("/vsi") ? fs::path(name) : fs::weakly_canonical(name, none);
    const fs::path folder = (none ? fs::path(name) : real).parent_path();
    for (const Source& source : sources_in(name, text)) check(name, folder, source, depth);
  }

  void check(const std::string& vrt, const fs::path& folder, const Source& source, int depth) {
    const bool plain = source.relative && source.name.find(':') == std::string::npos && source.name[0] != '/';
    const std::string name = plain ? in_folder(folder, source.name) : source.name;
    if (!seen_.insert(name).second) return;
    const InputName found = looked_up(name, source.relative ? folder : fs::path());
    if (!found.fault.empty()) throw InputError(vrt + ": names '" + source.name + "', which " + found.fault);
    if (found.network || name.starts_with("/vsi")) files_.insert(name);
    if (found.network) return;
    if (found.file.empty()) throw InputError(vrt + ": names '" + source.name + "', which is not there");
    require_below(vrt, found.file);
    if (!name.starts_with("/vsi")) files_.insert(found.file);
    check(name.starts_with("/vsi") ? name : found.file, depth + 1);
  }

  void require_below(const std::string& vrt, const std::string& file) const {
    std::error_code none;
    const fs::path given = fs::absolute(file).lexically_normal(), real = fs::weakly_canonical(file, none);
    for (const fs::path& folder : folders_)
      if (is_below(given, folder) || is_below(real, fs::weakly_canonical(folder, none))) return;
    throw InputError(vrt + ": names " + given.string() +
                     ", which lies neither below the folder of the VRT nor below that of the scenario: allow it with "
                     "--allow-folder " +
                     given.parent_path().string());
  }

  std::string name_;
  std::vector<fs::path> folders_;
  std::set<std::string> seen_, files_;
};

}  // namespace

bool is_vrt(const std::string& name) {
  const InputName found = looked_up(name);
  return found.fault.empty() && !found.file.empty() && has_mark(name);
}

void check_vrt(const std::string& name, const std::string& file) {
  VrtCheck(name, file);
}

std::vector<std::string> files_of_vrt(const std::string& name, const std::string& file) {
  const VrtCheck vrt(name, file);
  return {vrt.files().begin(), vrt.files().end()};
}

}  // namespace talus::io
