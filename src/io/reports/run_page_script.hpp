#pragma once
#include "markup.hpp"

namespace talus::io {

/// The script of the page of a run: the slider between two maps, and the values of the clicked cell.
Markup run_page_script();

}  // namespace talus::io
