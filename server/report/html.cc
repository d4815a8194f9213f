// SPDX-License-Identifier: Apache-2.0
#include "server/report/html.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string_view>

#include <openssl/evp.h>

#include "jobs/base/ids.h"

namespace server::report {

namespace {

constexpr std::string_view kStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 70rem;
       margin: 2rem auto; padding: 0 1rem; }
h2 { margin-top: 2rem; border-bottom: 1px solid #ccc; break-after: avoid; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.85rem; }
th, td { padding: 0.2rem 0.8rem 0.2rem 0; border-bottom: 1px solid #ddd; text-align: left;
         vertical-align: top; }
.number { text-align: right; }
thead { display: table-header-group; }
pre { background: #f4f4f4; padding: 0.8rem; white-space: pre-wrap; overflow-wrap: anywhere; }
svg { max-width: 100%; height: auto; }
figure { margin: 1rem 0; break-inside: avoid; }
figcaption, .quiet { color: #555; font-size: 0.85rem; }
.headlines { font-size: 1.1rem; padding-left: 1.2rem; }
.notes { white-space: pre-wrap; }
.wide { overflow-x: auto; }
@page { size: A4; margin: 14mm 12mm; }
@media print {
  body { margin: 0; padding: 0; max-width: none; font-size: 10.5px; }
  h1 { margin-top: 0; }
  .wide { overflow: visible; }
  table { width: 100%; font-size: 8.5px; }
  th, td { padding: 0.15rem 0.4rem 0.15rem 0; }
  th { font-size: 7.5px; }
  td.number { white-space: nowrap; }
  tr { break-inside: avoid; }
  .headlines { font-size: 12px; }
  figcaption, .quiet { font-size: 9px; }
}
)";

std::string style_hash() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  EVP_Digest(kStyle.data(), kStyle.size(), digest.data(), &size, EVP_sha256(), nullptr);
  std::array<unsigned char, 2 * EVP_MAX_MD_SIZE> text{};
  const int length = EVP_EncodeBlock(text.data(), digest.data(), static_cast<int>(size));
  return {reinterpret_cast<const char*>(text.data()), static_cast<std::size_t>(length)};
}

/// Text that stands for a sign of HTML; empty for any other character.
std::string_view entity_of(char c) {
  switch (c) {
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '&': return "&amp;";
    case '"': return "&quot;";
    default: return "";
  }
}

}  // namespace

std::string escape(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const std::string_view entity = entity_of(c);
    if (entity.empty()) safe += c;
    else safe += entity;
  }
  return safe;
}

std::string cell_text(const nlohmann::json& cell) {
  if (cell.is_null()) return "–";
  if (cell.is_string()) return cell.get<std::string>();
  if (!cell.is_number_float()) return cell.dump();
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.5g", cell.get<double>());
  return text.data();
}

namespace {

bool has_numbers(const std::vector<std::vector<nlohmann::json>>& rows, std::size_t column) {
  return std::ranges::any_of(rows, [&](const auto& row) { return row[column].is_number(); });
}

/// A job's id leads to its page, from below /v1/sweeps/{id}/.
std::string cell_html(const nlohmann::json& cell) {
  const std::string text = escape(cell_text(cell));
  if (!text.starts_with(jobs::kJobPrefix)) return text;
  return "<a href=\"../../../#/jobs/" + text + "\">" + text + "</a>";
}

std::string make_table_head(const std::vector<std::string>& headings,
                            const std::vector<std::vector<nlohmann::json>>& rows) {
  if (headings.empty()) return "";
  std::string html = "<thead><tr>";
  for (std::size_t c = 0; c < headings.size(); ++c)
    html += std::string("<th scope=\"col\"") + (has_numbers(rows, c) ? " class=\"number\"" : "") + ">" +
            escape(headings[c]) + "</th>";
  return html + "</tr></thead>";
}

}  // namespace

std::string make_table(const std::vector<std::string>& headings,
                       const std::vector<std::vector<nlohmann::json>>& rows) {
  // A table that may be wider than the window is reached with the keyboard, too.
  std::string html = "<div class=\"wide\" tabindex=\"0\" role=\"group\" aria-label=\"Table\"><table>";
  html += make_table_head(headings, rows) + "<tbody>\n";
  for (const auto& row : rows) {
    html += "<tr>";
    for (const auto& cell : row)
      html += (cell.is_number() ? "<td class=\"number\">" : "<td>") + cell_html(cell) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string make_page(const std::string& title, const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'sha256-" +
         style_hash() +
         "'\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escape(title) + "</title>\n<style>" + std::string(kStyle) + "</style>\n</head>\n<body>\n<main>\n" +
         body + "</main>\n</body>\n</html>\n";
}

std::string page_policy() {
  return "default-src 'none'; style-src 'sha256-" + style_hash() +
         "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

}  // namespace server::report
