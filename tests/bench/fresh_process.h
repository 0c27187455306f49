#pragma once

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace komorebi::bench {

/// What `work` returns in a process of its own, forked from this one: memory that nobody has
/// touched, threads that do not run yet. To be called while this process has no other thread.
/// What it has freed goes back to the system first: the other process would reuse it, and with each
/// first write to one of its pages pay for a copy of what nobody wants.
inline std::vector<double> in_fresh_process(const std::function<std::vector<double>()>& work) {
  malloc_trim(0);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    int code = 0;
    try {
      const std::vector<double> values = work();
      const std::size_t bytes = values.size() * sizeof(double);
      if (write(ends[1], values.data(), bytes) != static_cast<ssize_t>(bytes)) code = 1;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      code = 1;
    }
    _exit(code);
  }
  close(ends[1]);
  std::vector<double> values;
  for (double value; read(ends[0], &value, sizeof value) == sizeof value;) values.push_back(value);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw std::runtime_error("a measuring process failed");
  return values;
}

/// "VmRSS" or "VmHWM" of this process, in bytes.
inline double memory(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(name + ":", 0) == 0) return 1024.0 * std::stod(line.substr(name.size() + 1));
  }
  return 0.0;
}

/// From now on VmHWM is the most that this process holds from here.
inline void forget_peak() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace komorebi::bench
