#pragma once
#include <string>
#include <vector>

#include "talus/run/run_session.hpp"

namespace talus::run {

/// What `merge` is asked for.
struct MergeRequest {
  std::string out;
  std::vector<std::string> parts;    ///< folders
  std::string memory;                ///< "2G"; empty: no limit
  std::vector<std::string> command;  ///< the words that the program was called with
  int threads = 0;                   ///< 0: as many as the machine has
  bool overwrite = false;
};

/// Joins the parts of a run: the results are those of one run, bit for bit. Throws InputError where the parts are not
/// one whole; Interrupted.
Outcome merge(const MergeRequest& request, Observer& observer);

}  // namespace talus::run
