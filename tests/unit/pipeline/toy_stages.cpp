#include "toy_stages.hpp"

#include <algorithm>
#include <sstream>

#include "drape/base/log.hpp"

namespace drape::test {
namespace {

using pipeline::Input;
using pipeline::Stage;
using pipeline::StageRun;

struct ReadOptions {
  int words = 100;
};
void describe(Binder& b, ReadOptions& o) {
  b.number("words", o.words, {0, 1000}, "how many words are kept");
}

struct ChangeOptions {
  bool capitals = true;
  bool fail = false;
};
void describe(Binder& b, ChangeOptions& o) {
  b.flag("capitals", o.capitals, "write capitals");
  b.flag("fail", o.fail, "fail half-way");
}

struct NoOptions {};
void describe(Binder&, NoOptions&) {}

void read(const ReadOptions& options, StageRun& run) {
  std::istringstream words(read_file(run.input().mesh));
  std::string kept;
  std::string word;
  for (int i = 0; i < options.words && words >> word; ++i) kept += word + " ";
  write_file(run.output("words.txt"), kept);
  run.metric("letters", static_cast<double>(kept.size()));
}

void change(const ChangeOptions& options, StageRun& run) {
  std::string text = read_file(run.artifact("read", "words.txt"));
  write_file(run.output("changed/half.txt"), text.substr(0, text.size() / 2));
  run.progress().update(0.5);
  if (options.fail) throw input_error("words.txt: asked to fail");
  if (options.capitals)
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
  if (text.find('?') != std::string::npos) {
    log::warn("there is a question");
    run.needs_review("a question mark");
  }
  write_file(run.output("changed/text.txt"), text);
}

void count(const NoOptions&, StageRun& run) {
  write_file(run.output("count.txt"), std::to_string(read_file(run.artifact("read", "words.txt")).size()));
}

void publish(const NoOptions&, StageRun& run) {
  write_file(run.output("all.txt"), read_file(run.artifact("change", "changed/text.txt")) +
                                        read_file(run.artifact("count", "count.txt")));
}

class Quiet : public pipeline::RunObserver {
 public:
  void stage_started(const Stage&, std::size_t, std::size_t, const std::string&) override {}
  void stage_progress(const Stage&, double, std::string_view) override {}
  void stage_finished(const Stage&, std::size_t, std::size_t, const pipeline::StageRecord&, bool) override {}
};

Stage make(const std::string& name, std::vector<std::string> parts, std::vector<pipeline::Artifact> reads,
           std::vector<std::string> writes, std::function<Stage::Instance()> body) {
  Stage stage;
  stage.name = name;
  stage.summary = "Does " + name + ".";
  stage.input_parts = std::move(parts);
  stage.reads = std::move(reads);
  stage.writes = std::move(writes);
  stage.applies = [](const Input&) { return true; };
  stage.instantiate = std::move(body);
  return stage;
}

}  // namespace

std::vector<Stage> toy_stages() {
  std::vector<Stage> table;
  table.push_back(make("read", {"mesh"}, {}, {"words.txt"}, pipeline::stage_body(read)));
  table.push_back(
      make("change", {}, {{"read", "words.txt"}}, {"changed/*.txt"}, pipeline::stage_body(change)));
  table.push_back(
      make("count", {"units"}, {{"read", "words.txt"}}, {"count.txt"}, pipeline::stage_body(count)));
  table.push_back(make("publish", {}, {{"change", "changed/*.txt"}, {"count", "count.txt"}}, {"all.txt"},
                       pipeline::stage_body(publish)));
  table.back().published = true;
  return table;
}

ToyProject::ToyProject() {
  write_text("one two three");
  write_config("");
}

void ToyProject::write_config(const std::string& sections) const {
  write_file(folder_ / "toy.yaml", "input:\n  mesh: text.txt\n" + sections);
}

pipeline::Config ToyProject::load(const std::vector<std::string>& sets) const {
  return pipeline::load_config(folder_ / "toy.yaml", table_, sets);
}

std::string ToyProject::run(const std::vector<std::string>& sets, pipeline::RunOptions options) {
  const pipeline::Config config = load(sets);
  Quiet observer;
  last = pipeline::run(config, options, observer);
  std::string ran;
  for (const pipeline::RunStage& stage : last.record.stages)
    if (stage.ran) ran += (ran.empty() ? "" : " ") + stage.stage;
  return ran;
}

}  // namespace drape::test
