#include "drape/base/log.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "drape/base/error.hpp"

namespace drape::log {
namespace {

spdlog::level::level_enum to_spdlog(Level level) {
  switch (level) {
    case Level::debug:
      return spdlog::level::debug;
    case Level::info:
      return spdlog::level::info;
    case Level::warning:
      break;
  }
  return spdlog::level::warn;
}

class CaptureSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  std::vector<std::string> copy() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (message.level >= spdlog::level::warn)
      messages_.emplace_back(message.payload.data(), message.payload.size());
  }
  void flush_() override {}

 private:
  std::vector<std::string> messages_;
};

// The sinks of the process. A log is global by nature; it is the only state in drape that is.
struct Sinks {
  std::mutex mutex;
  std::shared_ptr<spdlog::sinks::sink> console = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  std::vector<std::shared_ptr<spdlog::sinks::sink>> extra;

  Sinks() {
    console->set_pattern("%^%l:%$ %v");
    console->set_level(spdlog::level::info);
  }

  void add(std::shared_ptr<spdlog::sinks::sink> sink) {
    const std::lock_guard<std::mutex> lock(mutex);
    extra.push_back(std::move(sink));
  }
  void remove(const std::shared_ptr<spdlog::sinks::sink>& sink) {
    const std::lock_guard<std::mutex> lock(mutex);
    std::erase(extra, sink);
  }
};

Sinks& sinks() {
  static Sinks instance;
  return instance;
}

}  // namespace

void write(Level level, std::string_view message) {
  const spdlog::details::log_msg entry("drape", to_spdlog(level),
                                       spdlog::string_view_t(message.data(), message.size()));
  Sinks& all = sinks();
  const std::lock_guard<std::mutex> lock(all.mutex);
  if (all.console->should_log(entry.level)) {
    all.console->log(entry);
    all.console->flush();
  }
  for (const auto& sink : all.extra) {
    // A log that cannot be written (a full disk) must not end the work; that is told where results are
    // written.
    try {
      if (sink->should_log(entry.level)) sink->log(entry);
    } catch (const spdlog::spdlog_ex&) {
    }
  }
}

void set_console_level(Level level) {
  sinks().console->set_level(to_spdlog(level));
}

struct FileSink::Impl {
  std::shared_ptr<spdlog::sinks::basic_file_sink_mt> sink;
};

FileSink::FileSink(const std::filesystem::path& file) : impl_(nullptr) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string(), true);
    sink->set_pattern("%Y-%m-%dT%H:%M:%S.%e %l %v");
    sink->set_level(spdlog::level::debug);
    impl_ = new Impl{std::move(sink)};
  } catch (const spdlog::spdlog_ex& failure) {
    throw io_error("{}: cannot open the log file: {}", file.string(), failure.what());
  }
  sinks().add(impl_->sink);
}

FileSink::~FileSink() {
  sinks().remove(impl_->sink);
  try {
    impl_->sink->flush();
  } catch (const spdlog::spdlog_ex&) {
  }
  delete impl_;
}

struct WarningCapture::Impl {
  std::shared_ptr<CaptureSink> sink = std::make_shared<CaptureSink>();
};

WarningCapture::WarningCapture() : impl_(new Impl) {
  sinks().add(impl_->sink);
}

WarningCapture::~WarningCapture() {
  sinks().remove(impl_->sink);
  delete impl_;
}

std::vector<std::string> WarningCapture::warnings() const {
  return impl_->sink->copy();
}

}  // namespace drape::log
