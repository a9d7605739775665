#include "run_support.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "commands.hpp"
#include "progress.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "write_maps.hpp"

Stopwatch::Lap Stopwatch::lap() {
  const Lap now = read(), lap{now.cpu - last_.cpu, now.wall - last_.wall};
  last_ = now;
  return lap;
}

Stopwatch::Lap Stopwatch::read() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return {static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec),
          std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count()};
}

void stop_interrupted() {
  throw Interrupted("interrupted; nothing was written");
}

std::string command_to_resume() {
  std::string again = command_line().front().ends_with("-mpi") ? "mpirun ... " : "";
  for (const std::string& word : command_line())
    if (word != "--resume") again += word + " ";
  return again + "--resume";
}

void together(talus::ProcessGroup& processes, const std::function<void()>& what) {
  if (processes.size() == 1) return what();
  std::string fault;
  try {
    what();
  } catch (const talus::InputError& error) {
    fault = error.what();
  }
  std::string first;
  for (const std::string& given : processes.gather(fault))
    if (first.empty()) first = given;
  first = processes.tell(first);
  if (!first.empty()) throw WrongForAll(first);
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::size_t memory_limit_of(const std::string& text, int threads) {
  double number = 0.0;
  char unit = ' ', end = ' ';
  const int read = std::sscanf(text.c_str(), "%lf%c%c", &number, &unit, &end);
  const double factor = unit == 'G' ? 1e9 : unit == 'M' ? 1e6 : 0.0;
  if (read != 2 || factor == 0.0 || !(number * factor <= 1e15))
    throw talus::InputError("--memory '" + text +
                            "': must be a number with M or G (10^6 or 10^9 bytes), such as 500M or 2G");
  const double least = std::max(140.0 + 30.0 * threads, 150.0 + 50.0 * std::min(threads, kMapsAtOnce));  // measured
  if (!(number * factor >= 1e6 * least))
    throw talus::InputError("--memory '" + text + "' with " + std::to_string(threads) +
                            (threads == 1 ? " thread: must be " : " threads: must be ") + talus::text_of(least) +
                            "M at least; give fewer --threads or more --memory");
  return static_cast<std::size_t>(number * factor);
}

std::uint64_t count_of(const talus::Totals& totals, talus::End end) {
  return totals.ends[static_cast<std::size_t>(end)];
}

std::string share_text(std::uint64_t part, std::uint64_t whole) {
  return talus::with_digits(100.0 * static_cast<double>(part) / static_cast<double>(whole), 3) + " %";
}

std::string ends_text(const talus::Totals& totals) {
  return count_text(count_of(totals, talus::End::Stopped)) + " stopped, " +
         count_text(count_of(totals, talus::End::Left)) + " left the map, " +
         count_text(count_of(totals, talus::End::Caught)) + " caught, " +
         count_text(count_of(totals, talus::End::Limit)) + " at a limit";
}

std::string limits_text(const talus::Totals& totals) {
  const std::uint64_t limits = count_of(totals, talus::End::Limit);
  return count_text(limits) + " of " + count_text(totals.released) + " trajectories (" +
         share_text(limits, totals.released) + ", allowed are 0.1 %) ended at the limit of impacts or time";
}
