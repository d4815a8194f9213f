// SPDX-License-Identifier: Apache-2.0
#include "server/messages/json_text.h"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace server {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kNonFiniteWords{"NaN", "-Infinity", "Infinity", "-NaN"};

/// Reads a text without keeping it, and ends at the first thing that passes a bound. A part of it that is no
/// JSON is for the next reader to tell.
class Bounds : public nlohmann::json_sax<Json> {
 public:
  explicit Bounds(std::size_t most_values) : most_values_(most_values) {}
  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return count(); }
  bool start_object(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

  bool key(string_t& key) override {
    if (!open_.back().insert(key).second) throw BadJson("the key \"" + key + "\" stands twice in one object");
    if (open_.back().size() > kMaxObjectKeys) {
      throw BadJson("more than " + std::to_string(kMaxObjectKeys) + " keys in one object");
    }
    return true;
  }

 private:
  bool count() {
    if (++values_ > most_values_) throw BadJson("more than " + std::to_string(most_values_) + " values");
    return true;
  }

  bool open() {
    count();
    open_.emplace_back();
    if (open_.size() > kMaxJsonDepth)
      throw BadJson("nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  const std::size_t most_values_;
  std::size_t values_ = 0;
  std::vector<std::set<std::string>> open_;  ///< the keys met so far, of every object or array that is open
};

/// Length of the word at the beginning of a text; 0 if there is none of them.
std::size_t measure_non_finite_word(std::string_view text) {
  const auto word =
      std::ranges::find_if(kNonFiniteWords, [&](std::string_view w) { return text.starts_with(w); });
  return word == kNonFiniteWords.end() ? 0 : word->size();
}

/// A text in which words are replaced, of the same length but for the shortest word, NaN.
struct MendedText {
  std::string text;
  std::vector<std::size_t> longer;  ///< ends of the words that are a byte longer than before

  /// @param byte  of the text, from 1
  [[nodiscard]] std::size_t byte_before(std::size_t byte) const {
    return byte - static_cast<std::size_t>(std::ranges::upper_bound(longer, byte) - longer.begin());
  }
};

/// The text with the words NaN and Infinity, which Python and others write for numbers that JSON cannot hold,
/// as null: then the fault is reported where it stands, as any other value of a wrong type.
MendedText without_non_finite_words(std::string_view text) {
  constexpr std::string_view kNull = "null";
  MendedText result;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (const auto length = in_string ? 0 : measure_non_finite_word(text.substr(i)); length > 0) {
      result.text.append(kNull).append(std::max(length, kNull.size()) - kNull.size(), ' ');
      if (length < kNull.size()) result.longer.push_back(result.text.size());
      i += length - 1;
      continue;
    }
    if (text[i] == '"') in_string = !in_string;
    else if (in_string && text[i] == '\\' && i + 1 < text.size()) result.text += text[i++];
    result.text += text[i];
  }
  return result;
}

/// The message of the parser without its bracketed name, which means nothing to a user.
std::string plain_message(const std::string& what) {
  const auto end = what.find("] ");
  return end == std::string::npos ? what : what.substr(end + 2);
}

/// @param mended  where the parser's line and column are not those of the text that was sent
std::string describe_parse_error(const Json::parse_error& error, const MendedText& mended) {
  std::string message = plain_message(error.what());
  if (!mended.longer.empty()) message.erase(0, message.find(": ") + 2);
  return "not JSON at byte " + std::to_string(mended.byte_before(error.byte)) + ": " + message;
}

Json parse_strictly(std::string_view text, std::size_t most_values, const MendedText& mended = {}) {
  // Twice: a callback of the parser could watch it, but then the parser looks, for every object that ends, at
  // all before it in their list.
  Bounds bounds(most_values);
  Json::sax_parse(text.begin(), text.end(), &bounds);
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& error) {
    throw BadJson(describe_parse_error(error, mended));
  } catch (const Json::exception& error) {
    throw BadJson(plain_message(error.what()));
  }
}

}  // namespace

nlohmann::ordered_json parse_json(std::string_view text, std::size_t most_values) {
  if (text.empty()) throw BadJson("there is no JSON: the text is empty");
  // The parser takes it for the end of the text, whatever comes after.
  if (const auto nul = text.find('\0'); nul != std::string_view::npos)
    throw BadJson("not JSON at byte " + std::to_string(nul + 1) + ": a NUL character");
  try {
    return parse_strictly(text, most_values);
  } catch (const BadJson&) {
    const MendedText mended = without_non_finite_words(text);
    if (mended.text == text) throw;
    return parse_strictly(mended.text, most_values, mended);
  }
}

}  // namespace server
