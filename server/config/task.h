#ifndef DUET_SERVER_CONFIG_TASK_H_
#define DUET_SERVER_CONFIG_TASK_H_

namespace duet::server::config {

// What the program is started for.
enum class Task {
  kServe,
  kCheckConfig,  // load everything, report every mistake, and exit
  kPrintConfig,  // print every setting and its source, and exit
  kCheckHealth,  // ask the running server whether it is healthy, and exit
};

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_TASK_H_
