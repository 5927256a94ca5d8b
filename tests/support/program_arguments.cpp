#include "program_arguments.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "drape/base/error.hpp"
#include "drape/base/numbers.hpp"

namespace drape::test {
namespace {

bool is_named(const std::string& text) {
  return text.starts_with("--") || text.find('=') != std::string::npos;
}

std::string without_dashes(const std::string& text) {
  return text.starts_with("--") ? text.substr(2) : text;
}

}  // namespace

bool ProgramArguments::flag(const std::string& name) {
  known_.push_back(name);
  return std::erase_if(texts_, [&](const std::string& text) { return without_dashes(text) == name; }) > 0;
}

std::optional<std::string> ProgramArguments::text(const std::string& name) {
  known_.push_back(name);
  for (auto it = texts_.begin(); it != texts_.end(); ++it) {
    if (without_dashes(*it).starts_with(name + "=")) {
      const std::string value = it->substr(it->find('=') + 1);
      texts_.erase(it);
      return value;
    }
    if (*it != "--" + name) continue;
    if (it + 1 == texts_.end()) throw config_error("{} needs a value", *it);
    const std::string value = *(it + 1);
    texts_.erase(it, it + 2);
    return value;
  }
  return std::nullopt;
}

std::optional<int> ProgramArguments::integer(const std::string& name) {
  const std::optional<std::string> value = text(name);
  if (!value) return std::nullopt;
  const std::optional<std::int64_t> number = parse_integer(*value);
  if (!number || *number < 0 || *number > 1'000'000'000)
    throw config_error("{} is {}; it must be a whole number, 0 at least", name, *value);
  return static_cast<int>(*number);
}

std::vector<std::string> ProgramArguments::list(const std::string& name) {
  std::vector<std::string> parts;
  std::string rest = text(name).value_or("");
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    if (comma > 0) parts.push_back(rest.substr(0, comma));
    rest.erase(0, comma + 1);
  }
  return parts;
}

std::vector<std::string> ProgramArguments::words() {
  std::vector<std::string> words;
  std::copy_if(texts_.begin(), texts_.end(), std::back_inserter(words),
               [](const std::string& text) { return !is_named(text); });
  std::erase_if(texts_, [](const std::string& text) { return !is_named(text); });
  return words;
}

void ProgramArguments::read(const std::vector<Option>& options) {
  for (const Option& option : options) {
    const std::optional<std::string> value = text(option.name);
    if (!value) continue;
    // A list is written with commas between its numbers.
    const auto parsed = [&] {
      if (option.kind != OptionKind::numbers) return parse_option(option, *value);
      ProgramArguments numbers({"numbers=" + *value});
      return parse_option(option, numbers.list("numbers"));
    }();
    if (const auto* problem = std::get_if<std::string>(&parsed))
      throw config_error("{}={} {}", option.name, *value, *problem);
    option.assign(std::get<OptionValue>(parsed));
  }
}

void ProgramArguments::finish() const {
  if (texts_.empty()) return;
  const std::string name = without_dashes(texts_.front().substr(0, texts_.front().find('=')));
  const std::string meant = closest(name, known_);
  throw config_error("{}: there is no such argument{}", texts_.front(),
                     meant.empty() ? "" : "; did you mean " + meant + "?");
}

int measuring_main(int count, char** texts, const std::function<void(ProgramArguments&)>& body) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // what is measured is there, even if a time limit ends it
  try {
    ProgramArguments arguments(std::vector<std::string>(texts + 1, texts + count));
    body(arguments);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.code() == ErrorCode::config ? 64 : 1;
  }
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace drape::test
