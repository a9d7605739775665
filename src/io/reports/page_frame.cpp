#include "page_frame.hpp"

#include "io/files/checksum.hpp"
#include "io/files/own_files.hpp"
#include "io/gdal/picture.hpp"
#include "talus/base/version.hpp"

namespace talus::io {
namespace {

Markup page_style() {
  return "<style>body{font:15px/1.5 sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;color:#222}"
         ".broad{max-width:1200px}"
         "header{border-bottom:2px solid #444;margin-bottom:1em}header p,footer{color:#555;font-size:13px}"
         "header p{margin:0}h1{margin:0 0 .3em;line-height:1.25}h2{margin-top:1.6em;border-bottom:1px solid #ccc}"
         "h1,h2,h3,p,li,.b{overflow-wrap:anywhere}"
         "table{border-collapse:collapse;font-size:13px}td,th{border:1px solid #ccc;padding:3px 8px;text-align:left;"
         "vertical-align:top}th{background:#f3f3f3}td.n{text-align:right;white-space:nowrap}td.k{white-space:nowrap}"
         ".objects td{overflow-wrap:break-word}.objects td.n{white-space:normal;min-width:4.7em}"
         ".objects td:last-child{min-width:11em}.many{font-size:10px}.many td,.many th{padding:2px 4px}"
         ".many td.n{min-width:0}"
         ".sign{margin-top:1em;width:100%}.sign td{height:2.2em;width:18%}.sign td:nth-child(odd){width:12%;border:0}"
         "svg{max-width:100%;height:auto}text{font-family:sans-serif;font-size:11px}"
         "footer{border-top:1px solid #ccc;margin-top:2em;padding-top:.5em}"
         ".wide{overflow-x:auto;padding-right:1px}.hidden{position:absolute;width:0;height:0}figure{margin:1em 0}"
         ".look{background:#fff6d6}.act{background:#fde2de}.note{color:#555;font-size:13px}"
         "@page{margin:14mm}@media print{body{max-width:none;margin:0;padding:0;font-size:11pt}.screen{display:none}"
         "figure,tr,.whole,.sign{break-inside:avoid}h2,h3,.before,tr:first-child{break-after:avoid}"
         "tr:last-child,.sign{break-before:avoid}.wide{overflow:visible}"
         ".low{margin:0 0 4mm}.low svg{max-height:112mm}"
         "*{print-color-adjust:exact;-webkit-print-color-adjust:exact}}</style>"_html;
}

/// SHA-256 of a script as a browser's policy states it.
std::string base64_checksum(const std::string& script) {
  const std::string digits = sha256_of_bytes(script);
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return base64_of(bytes);
}

Markup policy(const Markup& script) {
  Markup head =
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'"_html;
  if (!script.empty()) (head += "; script-src 'sha256-").add_value(base64_checksum(script.text())) += "'";
  return head + "\">";
}

}  // namespace

std::string page_of(const PageFrame& frame, const Markup& body) {
  const std::string program = "talus " + std::string(version());
  Markup page = "<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'>"_html;
  (page += "<meta name=\"generator\" content=\"").add_value(kPageMark + frame.kind) += "\">";
  page += policy(frame.script) + "<meta name='viewport' content='width=device-width'><title>Talus: " + frame.title +
          "</title>" + page_style() + "</head>" + (frame.wide ? "<body class='broad'>"_html : "<body>"_html) +
          "\n<header><p>" + program + ", " + frame.kind + "</p><h1>" + frame.title + "</h1></header>\n" + body +
          "<footer>" + program + ", " + frame.footer + "</footer>\n";
  if (!frame.script.empty()) page += "<script>"_html + frame.script + "</script>\n";
  page += "</body></html>\n";
  return page.text();
}

}  // namespace talus::io
