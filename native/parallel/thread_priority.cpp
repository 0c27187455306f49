#include "parallel/thread_priority.h"

#if defined(__linux__)
#include <sys/resource.h>
#include <unistd.h>
#elif defined(__APPLE__)
#include <pthread/qos.h>
#elif defined(_WIN32)
#include <windows.h>
#endif

namespace komorebi {

void lower_priority() {
#if defined(__linux__)
  constexpr int kNice = 10;  // by Linux's table of weights 110 beside 1024
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
#elif defined(__APPLE__)
  pthread_set_qos_class_self_np(QOS_CLASS_UTILITY, 0);
#elif defined(_WIN32)
  SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
#endif
}

}  // namespace komorebi
