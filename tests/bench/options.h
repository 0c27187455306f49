#pragma once

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace komorebi::bench {

/// `--name value` pairs; lists are separated by commas.
class Options {
 public:
  Options(int count, char** words) {
    for (int i = 0; i < count; i += 2) {
      const std::string name = words[i];
      if (name.rfind("--", 0) != 0 || i + 1 >= count) {
        throw std::invalid_argument("expected --name value, not " + name);
      }
      values_[name.substr(2)] = words[i + 1];
    }
  }
  std::string text(const std::string& name, const std::string& otherwise) const {
    const auto found = values_.find(name);
    return found == values_.end() ? otherwise : found->second;
  }
  int whole(const std::string& name, int otherwise) const {
    return std::stoi(text(name, std::to_string(otherwise)));
  }
  std::vector<std::string> list(const std::string& name, const std::string& otherwise) const {
    std::vector<std::string> items;
    std::istringstream stream(text(name, otherwise));
    for (std::string item; std::getline(stream, item, ',');) items.push_back(item);
    return items;
  }
  std::vector<double> numbers(const std::string& name, const std::string& otherwise) const {
    std::vector<double> items;
    for (const std::string& item : list(name, otherwise)) items.push_back(std::stod(item));
    return items;
  }

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace komorebi::bench
