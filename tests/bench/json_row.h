#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace komorebi::bench {

/// One line of output: a flat JSON object. Names and texts are our own: nothing needs escaping.
class JsonRow {
 public:
  explicit JsonRow(const std::string& part) { text("part", part); }

  JsonRow& text(const char* name, const std::string& value) {
    return field(name, "\"" + value + "\"");
  }
  JsonRow& number(const char* name, double value) { return field(name, format(value)); }
  JsonRow& numbers(const char* name, const std::vector<double>& values) {
    std::string list = "[";
    for (const double value : values) list += (list.size() > 1 ? ", " : "") + format(value);
    return field(name, list + "]");
  }
  void print() const {
    std::printf("{%s}\n", content_.c_str());
    std::fflush(stdout);
  }

 private:
  static std::string format(double value) {
    if (!std::isfinite(value)) return "null";
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.9g", value);
    return buffer;
  }
  JsonRow& field(const char* name, const std::string& value) {
    if (!content_.empty()) content_ += ", ";
    content_ += std::string("\"") + name + "\": " + value;
    return *this;
  }
  std::string content_;
};

}  // namespace komorebi::bench
