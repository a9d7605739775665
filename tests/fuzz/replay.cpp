#include <algorithm>
#include <cstdio>
#include <iterator>
#include <vector>

#include "fuzz.hpp"

/// Runs a fuzz target on the files of the given folders, where the compiler has no fuzzer: `ctest -R fuzz` does so with
/// the cases that are kept in tests/fuzz/corpus.
int main(int count, char** words) {
  std::vector<std::filesystem::path> cases;
  for (int i = 1; i < count; ++i)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(words[i]))
      if (entry.is_regular_file()) cases.push_back(entry.path());
  std::sort(cases.begin(), cases.end());
  for (const auto& path : cases) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::printf("%zu cases\n", cases.size());
  return cases.empty() ? 1 : 0;
}
