#include "typed_cells.hpp"

#include <cmath>
#include <cstdlib>
#include <string>

#include "csv_table.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

/// Whether a text is its number as people write it ("-12.50"), or as `text_of` does ("1e-05").
bool is_spelt_as_number(const std::string& text, double number) {
  const std::size_t first = text[0] == '-' ? 1 : 0;
  if (text.find_first_not_of("0123456789.", first) != std::string::npos) return text == text_of(number);
  return text[first] != '0' || text.size() == first + 1 || text[first + 1] == '.';
}

/// The type of a column by its cells. The rule is that of `with_numbers`.
OGRFieldType type_of_cells(const std::vector<Feature>& features, int field) {
  const char* const column = features.front()->GetFieldDefnRef(field)->GetNameRef();
  const bool is_name = EQUAL(column, "name") || EQUAL(column, "id");
  OGRFieldType type = OFTString;
  for (const Feature& feature : features) {
    const std::string text = trimmed(feature->GetFieldAsString(field));
    if (text.empty()) continue;
    const auto number = number_of_cell(text);
    if (!number || !std::isfinite(*number)) return OFTString;
    const bool digits = text.find_first_not_of("0123456789", text[0] == '-' ? 1 : 0) == std::string::npos;
    if (digits && std::to_string(std::strtoll(text.c_str(), nullptr, 10)) != text) return OFTString;
    if (!digits && (is_name || !is_spelt_as_number(text, *number))) return OFTString;
    if (!digits)
      type = OFTReal;
    else if (type == OFTString)
      type = OFTInteger64;
  }
  return type;
}

}  // namespace

std::vector<Feature> with_numbers(const std::vector<Feature>& features) {
  OGRFeatureDefn* const columns = features.front()->GetDefnRef()->Clone();  // the features hold it
  for (int i = 0; i < columns->GetFieldCount(); ++i)
    if (columns->GetFieldDefn(i)->GetType() == OFTString) columns->GetFieldDefn(i)->SetType(type_of_cells(features, i));
  std::vector<Feature> out;
  for (const Feature& feature : features) {
    Feature& typed = out.emplace_back(OGRFeature::CreateFeature(columns));
    typed->SetFID(feature->GetFID());
    for (int i = 0; i < columns->GetFieldCount(); ++i) {
      if (feature->IsFieldSetAndNotNull(i) == 0) continue;
      const std::string text = feature->GetFieldAsString(i);
      const bool is_text = columns->GetFieldDefn(i)->GetType() == OFTString;
      if (is_text || !trimmed(text).empty()) typed->SetField(i, (is_text ? text : trimmed(text)).c_str());
    }
  }
  return out;
}

}  // namespace talus::io
