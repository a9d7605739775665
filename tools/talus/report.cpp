#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "facts.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/reports/run_page.hpp"

namespace fs = std::filesystem;

namespace {

struct ReportOptions {
  talus::io::RunPageRequest request;
  std::string folder, out;
  bool overwrite = false, quiet = false;
};

int report(ReportOptions options) {
  options.request.folder = options.folder;
  const fs::path file = options.out.empty() ? fs::path(options.folder) / "report.html" : fs::path(options.out);
  if (file.extension() != ".html")
    throw talus::InputError("-o: '" + options.out + "' must end in .html (the report is a page)");
  const talus::io::RunPageFile out(file, options.overwrite, options.folder);
  const std::string page = talus::io::run_page(options.request);
  catch_signals();  // from here on: the whole page
  out.write(page);
  if (!options.quiet)
    say("", "the report is in " + fs::absolute(file).lexically_normal().string() + " (" +
                talus::with_digits(1e-6 * static_cast<double>(page.size()), 2) +
                " MB, self-contained): open it in a browser, or print it to PDF there");
  return 0;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "One self-contained HTML page on a run: maps, tables, checklist");
  with(command->add_option("folder", options->folder, "OUT of talus run, with what hazard and barrier have added")
           ->required(),
       folder_of_results());
  with(command->add_option("-o,--out", options->out,
                           "file of the page (.html); report.html in the folder where it is not given"),
       new_file_of({"html"}));
  command->add_option("--title", options->request.title,
                      "title of the page; the name of the folder where it is not given");
  command->add_option("--attribution", options->request.attribution,
                      "whose terrain and maps these are, below every map; what the DEM states where it is not given");
  command->add_flag("--overwrite", options->overwrite, "replace an earlier page of talus report");
  add_quiet(*command, options->quiet);
  command->footer(
      "Example:\n  talus report result --title \"Rock fall above the road\" --attribution \"DEM: (c) swisstopo\"\n\n"
      "Run it last, after hazard and barrier: the page shows what is in the folder. docs/report.md says what that is.");
  command->callback([&action, options] { action = [options] { return report(*options); }; });
}
