#pragma once
#include <string>
#include <vector>

#include "talus/run/run_session.hpp"

namespace talus::run {

/// Options of a merge.
struct MergeRequest {
  std::string out;
  std::vector<std::string> parts;    ///< folders of the parts
  std::string memory;                ///< "2G"; empty: no limit
  std::vector<std::string> command;  ///< words of the command line
  int threads = 0;                   ///< 0: one per processor
  bool overwrite = false;
};

/// Joins the parts of a run: the results are those of one run, bit for bit. Throws InputError if a part is missing,
/// given twice or from another plan; Interrupted.
Outcome merge(const MergeRequest& request, Observer& observer);

}  // namespace talus::run
