#include "vrt_check.hpp"

#include <cpl_minixml.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
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

/// The bytes of one of GDAL's files; at most `most`, and one more if there are more.
std::string content_of(const std::string& name, std::size_t most) {
  const std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)> file(VSIFOpenL(name.c_str(), "rb"), VSIFCloseL);
  std::string text;
  constexpr std::size_t kStep = 1U << 16U;
  while (file && text.size() <= most) {
    const std::size_t before = text.size(), wanted = std::min(kStep, most + 1 - before);
    text.resize(before + wanted);
    const std::size_t count = VSIFReadL(text.data() + before, 1, wanted, file.get());
    text.resize(before + count);
    if (count == 0) break;
  }
  return text;
}

bool has_mark(const std::string& name) {
  return content_of(name, kHead).find(kMark) != std::string::npos;
}

/// A name in a VRT.
struct Source {
  std::string name;
  bool relative = false;  // to the folder of the VRT
};

bool names_source(const CPLXMLNode& node) {
  const std::string name = lowercase(node.pszValue);
  constexpr std::array<std::string_view, 3> kOthers{"sourcedataset", "srcdatasource", "dempath"};
  return name.ends_with("filename") || std::ranges::count(kOthers, std::string_view(name)) > 0;
}

/// The names of all files in the text of a VRT. Throws InputError if it asks for Python.
std::vector<Source> sources_in(const std::string& vrt, const std::string& text) {
  const GdalMessages quiet;
  const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> tree(CPLParseXMLString(text.c_str()),
                                                                       CPLDestroyXMLNode);
  std::vector<Source> sources;
  std::vector<const CPLXMLNode*> left;
  if (tree) left.push_back(tree.get());
  while (!left.empty()) {
    const CPLXMLNode* const node = left.back();
    left.pop_back();
    if (node->psNext != nullptr) left.push_back(node->psNext);
    if (node->psChild != nullptr) left.push_back(node->psChild);
    if (node->eType != CXT_Element && node->eType != CXT_Attribute) continue;
    const std::string value = CPLGetXMLValue(node, "", "");
    if (EQUAL(node->pszValue, "PixelFunctionLanguage") && EQUAL(value.c_str(), "Python"))
      throw InputError(vrt +
                       ": has a pixel function in Python, which is never run: write it to a raster first, with "
                       "gdal_translate");
    if (names_source(*node) && !value.empty())
      sources.push_back({value, std::atoi(CPLGetXMLValue(node, "relativeToVRT", "0")) != 0});
  }
  return sources;
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

/// A VRT with all that it names.
class VrtCheck {
 public:
  VrtCheck(const std::string& name, const std::string& file) : name_(name), folders_(allowed_folders()) {
    folders_.push_back(fs::absolute(file).lexically_normal().parent_path());
    check(name, 0);
  }

  /// The files that it names.
  const std::set<std::string>& files() const { return files_; }

 private:
  void check(const std::string& name, int depth) {
    if (!has_mark(name)) return;
    if (depth > kDeepest)
      throw InputError(name_ + ": VRTs in VRTs, more than " + std::to_string(kDeepest) +
                       " deep: does one name itself?");
    const std::string text = content_of(name, kMostVrt);
    if (text.size() > kMostVrt)
      throw InputError(name + ": has more than " + std::to_string(kMostVrt >> 20U) +
                       " MB, must be a smaller VRT: write it to a raster first, with gdal_translate");
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
    check(name, depth + 1);
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
