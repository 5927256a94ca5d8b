#include "command_line.hpp"

#include <fmt/core.h>

#include <map>

#include "batch_command_line.hpp"
#include "command_tree.hpp"
#include "drape/base/error.hpp"

namespace drape::app {
namespace {

std::string version_text() {
  std::string text;
  for (const auto& [name, version] : versions()) text += fmt::format("{} {}\n", name, version);
  return text;
}

const std::map<std::string, ProgressMode> progress_modes = {
    {"auto", ProgressMode::automatic}, {"plain", ProgressMode::plain}, {"json", ProgressMode::json}};

}  // namespace

CommandLine::CommandLine(const std::atomic<bool>& stop_requested) : stop_(stop_requested) {
  app.set_version_flag("--version", version_text(), "The versions of drape and its libraries");
  app.require_subcommand(1);
  app.add_option("--threads", threads, "The most threads; 0: one per core")->check(CLI::NonNegativeNumber);
  app.add_flag("-q,--quiet", quiet, "Warnings and errors only");
  app.add_flag("-v,--verbose", verbose, "Details too");
  app.fallthrough();
  add_run();
  add_status();
  add_explain();
  add_validate();
  add_new();
  add_info();
  add_convert();
  add_make();
  add_batch_commands(app, batch, action, stop_);
  add_gc();
  add_report();
  add_diff();
  add_adopt();
  add_reference();
  add_simulate();
  add_segment();
  add_align();
  add_relight();
  add_completion();
  add_manual();
  app.footer(
      "Examples:\n  drape new scans/*.ply --photo front.jpg -o statue.yaml\n  drape run statue.yaml\n"
      "Each command has its own --help.");
}

CLI::App* CommandLine::command(const std::string& name, const std::string& what, const std::string& example) {
  CLI::App* sub = app.add_subcommand(name, what);
  sub->footer("Example:\n  " + example);
  return sub;
}

void CommandLine::add_sets(CLI::App* sub, std::vector<std::string>& sets) {
  sub->add_option("--set", sets, "Takes the place of a value in the file; may be given again")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void CommandLine::add_progress(CLI::App* sub) {
  sub->add_option("--progress", progress, "How to show progress: auto, plain or json")
      ->transform(CLI::CheckedTransformer(progress_modes, CLI::ignore_case).description(""))
      ->type_name("MODE");
}

void CommandLine::add_run() {
  CLI::App* sub = command("run", "Run the stages of a configuration, as far as anything changed",
                          "drape run config/teapot.yaml --set fill.max_hole_size_spacings=100");
  sub->add_option("config", run.config, "The configuration")->required()->type_name("CONFIG");
  sub->add_option("--from", run.from, "Run this stage and all later ones again")->type_name("STAGE");
  sub->add_option("--until", run.until, "Stop after this stage")->type_name("STAGE");
  sub->add_option("--only", run.only, "Run this stage again, and no other")->type_name("STAGE");
  add_sets(sub, run.sets);
  sub->add_option("--workspace", run.workspace, "Folder for the stages' results")->type_name("DIR");
  sub->add_option("--name", run.name, "Name of the run; default: the configuration's")->type_name("NAME");
  sub->add_option("--fixes", run.fixes, "Corrections to keep for this run; none: forget those that it has")
      ->type_name("FILE");
  sub->add_flag("--dry-run", run.dry_run, "Say what would run, and how long it may take, and run nothing");
  add_progress(sub);
  sub->callback([this] {
    action = [this] {
      run.progress = progress;
      run.quiet = quiet;
      run_command(run, stop_);
      return 0;
    };
  });
}

void CommandLine::add_status() {
  CLI::App* sub = command("status", "List the runs of a workspace", "drape status config/teapot.yaml");
  sub->add_option("where", status, "A workspace, a folder with one, or a configuration; default: here");
  sub->callback([this] {
    action = [this] {
      status_command(status);
      return 0;
    };
  });
}

void CommandLine::add_explain() {
  CLI::App* sub = command("explain", "Say what would run again, and which option or file is the reason",
                          "drape explain config/teapot.yaml --set mesh.method=advancing_front");
  sub->add_option("config", explain.config, "The configuration")->required()->type_name("CONFIG");
  sub->add_option("stage", explain.stage, "Only this stage")->type_name("STAGE");
  add_sets(sub, explain.sets);
  sub->add_option("--workspace", explain.workspace, "Folder for the stages' results")->type_name("DIR");
  sub->add_option("--name", explain.name, "Name of the run; default: the configuration's")->type_name("NAME");
  sub->callback([this] {
    action = [this] {
      explain_command(explain);
      return 0;
    };
  });
}

void CommandLine::add_validate() {
  CLI::App* sub = command("validate", "Check a configuration and the files it names, and run nothing",
                          "drape validate config/teapot.yaml");
  sub->add_option("config", validate.config, "The configuration")->required()->type_name("CONFIG");
  add_sets(sub, validate.sets);
  sub->callback([this] {
    action = [this] {
      validate_command(validate);
      return 0;
    };
  });
}

void CommandLine::add_new() {
  CLI::App* sub = command("new", "Write a configuration for scans (or one mesh) and photos",
                          "drape new scans/*.ply --photo front.jpg --photo back.jpg -o statue.yaml");
  sub->add_option("scans", create.scans, "Scan files, or one mesh; a Stanford .conf gives their poses")
      ->required()
      ->type_name("SCANS");
  sub->add_option("--photo", create.photos, "A photo; may be given again")
      ->type_name("FILE")
      ->allow_extra_args(false);
  create.output = "drape.yaml";
  sub->add_option("-o,--output", create.output, "The configuration to write; default: drape.yaml")
      ->type_name("CONFIG");
  sub->add_flag("--force", create.force, "Write over an existing file");
  sub->callback([this] {
    action = [this] {
      new_command(create);
      return 0;
    };
  });
}

void CommandLine::add_make() {
  CLI::App* sub =
      command("make", "From scans (or one mesh) and photos to a model in one go, with the defaults",
              "drape make scans/*.ply --photo front.jpg -o statue");
  sub->add_option("scans", make.create.scans, "Scan files, or one mesh; a Stanford .conf gives their poses")
      ->required()
      ->type_name("SCANS");
  sub->add_option("--photo", make.create.photos, "A photo; may be given again")
      ->type_name("FILE")
      ->allow_extra_args(false);
  sub->add_option("-o,--output", make.create.output,
                  "Folder for everything: drape.yaml, model, drape-workspace")
      ->required()
      ->type_name("DIR");
  add_sets(sub, make.run.sets);
  add_progress(sub);
  sub->callback([this] {
    action = [this] {
      make.run.progress = progress;
      make.run.quiet = quiet;
      make.run.command = run.command;
      make_command(make, stop_);
      return 0;
    };
  });
}

void CommandLine::add_gc() {
  CLI::App* sub =
      command("gc", "List results that no run uses, or remove them", "drape gc --max-size 20GB --delete");
  sub->add_option("where", gc.where, "A workspace, a folder with one, or a configuration; default: here");
  sub->add_flag("--delete", gc.remove, "Remove them; without it they are only listed");
  sub->add_option("--max-size", gc.max_size, "Remove only the oldest, until all results are under this size")
      ->type_name("SIZE");
  sub->add_option("--min-age-hours", gc.min_age_hours, "Younger results stay; default: 1")
      ->check(CLI::NonNegativeNumber)
      ->type_name("H");
  sub->callback([this] {
    action = [this] {
      gc_command(gc);
      return 0;
    };
  });
}

void CommandLine::add_report() {
  CLI::App* sub =
      command("report", "Write the page of a run, a sweep or a batch anew, without running anything",
              "drape report teapot --workspace config");
  sub->add_option("what", report.what,
                  "A run (its name, its folder, or its configuration), the configuration of a sweep, or "
                  "the manifest "
                  "or folder of a batch")
      ->required()
      ->type_name("RUN|SWEEP|BATCH");
  sub->add_option("--workspace", report.workspace, "Where a run that is given by name lies; default: here")
      ->type_name("DIR");
  sub->callback([this] {
    action = [this] {
      report_command(report);
      return 0;
    };
  });
}

void CommandLine::add_diff() {
  CLI::App* sub = command("diff", "Compare two runs: options, numbers, and pictures side by side on a page",
                          "drape diff teapot front --workspace config -o diff.html");
  sub->add_option("a", diff.a, "A run: its name, its folder, or its configuration")
      ->required()
      ->type_name("RUN_A");
  sub->add_option("b", diff.b, "Another run")->required()->type_name("RUN_B");
  sub->add_option("--workspace", diff.workspace, "Where runs that are given by name lie; default: here")
      ->type_name("DIR");
  sub->add_option("-o,--output", diff.output, "The page to write; default: diff.html")->type_name("FILE");
  sub->callback([this] {
    action = [this] {
      diff_command(diff);
      return 0;
    };
  });
}

void CommandLine::add_adopt() {
  CLI::App* sub = command("adopt", "Let a file made by hand stand for one that a stage makes",
                          "drape adopt config/teapot.yaml mesh mended.ply");
  sub->add_option("run", adopt.run, "A run: its name, its folder, or its configuration")
      ->required()
      ->type_name("RUN");
  sub->add_option("stage", adopt.stage, "The stage")->required()->type_name("STAGE");
  CLI::Option* file = sub->add_option("file", adopt.file, "The file")->type_name("FILE");
  sub->add_option("--as", adopt.as,
                  "The stage's file that it stands for; default: that of the same name or kind")
      ->type_name("NAME");
  sub->add_flag("--forget", adopt.forget, "The stage makes its own files again")->excludes(file);
  sub->add_option("--workspace", adopt.workspace, "Where a run that is given by name lies; default: here")
      ->type_name("DIR");
  sub->callback([this] {
    action = [this] {
      if (adopt.file.empty() && !adopt.forget) throw config_error("adopt needs a FILE, or --forget");
      adopt_command(adopt);
      return 0;
    };
  });
}

void CommandLine::add_info() {
  CLI::App* sub = command("info", "Say what is in scan files, meshes, photos and files of poses",
                          "drape info scans/*.ptx photos/front.jpg");
  sub->add_option("files", info.files, "The files")->required()->type_name("FILES");
  sub->callback([this] {
    action = [this] {
      info_command(info);
      return 0;
    };
  });
}

void CommandLine::add_convert() {
  CLI::App* sub = command("convert",
                          "Write a scan file as .ply, .pcd, .xyz, .txt, .asc or .csv; several scans in "
                          "it become several files",
                          "drape convert survey.e57 survey.ply");
  sub->add_option("input", convert.input, "Any scan file")->required()->type_name("IN");
  sub->add_option("output", convert.output, "The file to write")->required()->type_name("OUT");
  sub->callback([this] {
    action = [this] {
      convert_command(convert);
      return 0;
    };
  });
}

void CommandLine::add_reference() {
  CLI::App* sub =
      command("reference", "Write the reference page of all options", "drape reference config/REFERENCE.md");
  sub->add_option("file", reference, "The page to write; default: config/REFERENCE.md")->type_name("FILE");
  sub->add_flag("--check", reference_check,
                "Write nothing; exit with 65 if the page is not as it would be written");
  sub->callback([this] {
    action = [this] {
      if (reference_command(reference, reference_check)) return 0;
      throw input_error("{}: is stale; make it again with: drape reference {}", reference.string(),
                        reference.string());
    };
  });
}

void CommandLine::add_completion() {
  CLI::App* sub = command("completion", "Print a script that completes drape's words in a shell",
                          "drape completion bash >~/.local/share/bash-completion/completions/drape");
  sub->add_option("shell", shell, "bash or zsh")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}))
      ->type_name("SHELL");
  sub->callback([this] {
    action = [this] {
      const auto tree = command_tree(app);
      fmt::print("{}",
                 shell == "zsh" ? zsh_completion(tree, value_words()) : bash_completion(tree, value_words()));
      return 0;
    };
  });
}

void CommandLine::add_manual() {
  CLI::App* sub = command("manual", "Print the manual page, for man", "drape manual >drape.1");
  sub->callback([this] {
    action = [this] {
      fmt::print("{}", manual_page(command_tree(app)));
      return 0;
    };
  });
}

void CommandLine::add_segment() {
  CLI::App* sub = command("segment", "Find the object in one photo: segments and stencil, without a mesh",
                          "drape segment photo.jpg --box 120,80,400,600 -o /tmp/segments");
  sub->add_option("photo", segment.photo, "The photo")->required()->type_name("PHOTO");
  sub->add_option("--method", segment.method, "As segment.method of a configuration; default: auto")
      ->type_name("METHOD");
  sub->add_option("--box", segment.box, "A box around the object, in pixels")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X,Y,WIDTH,HEIGHT");
  sub->add_option("--click", segment.click, "A point inside the object, in pixels")
      ->delimiter(',')
      ->expected(2)
      ->type_name("X,Y");
  sub->add_option("--mask", segment.mask, "White where the object is")->type_name("FILE");
  sub->add_option("--scribbles", segment.scribbles, "White strokes on the object, black on the rest, on grey")
      ->type_name("FILE");
  sub->add_option("--background", segment.background, "A photo of the same view without the object")
      ->type_name("FILE");
  sub->add_option("-o,--output", segment.output, "Folder to write; default: PHOTO-segments beside it")
      ->type_name("DIR");
  add_progress(sub);
  sub->callback([this] {
    action = [this] {
      segment.progress = quiet ? ProgressMode::none : progress;
      segment_command(segment, stop_);
      return 0;
    };
  });
}

void CommandLine::add_align() {
  CLI::App* sub = command("align", "Find the camera of one photo of a mesh",
                          "drape align statue.ply photo.jpg --box 120,80,400,600 -o /tmp/aligned");
  sub->add_option("mesh", align.mesh, "The mesh")->required()->type_name("MESH");
  sub->add_option("photo", align.photo, "The photo")->required()->type_name("PHOTO");
  sub->add_option("--evidence", align.evidence, "As align.evidence of a configuration; default: auto")
      ->type_name("EVIDENCE");
  sub->add_option("--box", align.box, "A box around the object, in pixels")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X,Y,WIDTH,HEIGHT");
  sub->add_option("--click", align.click, "A point inside the object, in pixels")
      ->delimiter(',')
      ->expected(2)
      ->type_name("X,Y");
  sub->add_option("--mask", align.mask, "White where the object is")->type_name("FILE");
  sub->add_option("-o,--output", align.output, "Folder to write; default: PHOTO-aligned beside it")
      ->type_name("DIR");
  add_progress(sub);
  sub->callback([this] {
    action = [this] {
      align.progress = quiet ? ProgressMode::none : progress;
      align_command(align, stop_);
      return 0;
    };
  });
}

void CommandLine::add_relight() {
  CLI::App* sub = command("relight", "Draw a model under a new light, with the shadows that it casts",
                          "drape relight teapot-model --azimuth 60 --elevation 30 -o relit.png");
  const auto number = [&](const std::string& name, double& value, double least, double most,
                          const std::string& what) {
    sub->add_option(name, value, what)
        ->capture_default_str()
        ->check(CLI::Range(least, most))
        ->type_name("NUMBER");
  };
  sub->add_option("model", relight.model,
                  "model.ply, the folder with it, or a mesh; the albedo if it is there")
      ->required()
      ->type_name("MODEL");
  number("--azimuth", relight.azimuth_deg, -360, 360,
         "Where the lamp is, in degrees counter-clockwise seen from above; 0 is the front");
  number("--elevation", relight.elevation_deg, -90, 90, "The lamp's height, in degrees over the horizon");
  number("--intensity", relight.intensity, 0, 1000,
         "At 1, white that faces the lamp is white in the picture");
  number("--ambient", relight.ambient, 0, 1000, "Light from all round, in the same measure");
  number("--softness", relight.softness_deg, 0, 45, "The lamp's radius in degrees: 0 casts hard shadows");
  number("--view-azimuth", relight.view_azimuth_deg, -360, 360, "Where the camera is, as --azimuth");
  number("--view-elevation", relight.view_elevation_deg, -89, 89, "The camera's height, as --elevation");
  sub->add_option("--size", relight.size_px, "Pixels a side")
      ->capture_default_str()
      ->check(CLI::Range(16, 4096))
      ->type_name("PIXELS");
  sub->add_option("--up", relight.up, "The axis of the model that points up")
      ->capture_default_str()
      ->check(CLI::IsMember({"y", "z"}))
      ->type_name("AXIS");
  sub->add_option("-o,--output", relight.output, "PNG or JPEG to write; default: MODEL-relit.png beside it")
      ->type_name("FILE");
  sub->callback([this] {
    action = [this] {
      relight_command(relight);
      return 0;
    };
  });
}

void CommandLine::add_simulate() {
  CLI::App* sub = command("simulate", "Make range scans and photos of a simulated object, with ground truth",
                          "drape simulate sample_scans/teapot.yaml -o /tmp/teapot");
  sub->add_option("spec", simulate.spec, "YAML that describes object, scanner and camera")
      ->required()
      ->type_name("SPEC");
  sub->add_option("-o,--output", simulate.output, "Folder to write; default: the name of SPEC beside it")
      ->type_name("DIR");
  add_sets(sub, simulate.sets);
  add_progress(sub);
  sub->callback([this] {
    action = [this] {
      simulate.progress = quiet ? ProgressMode::none : progress;
      simulate_command(simulate, stop_);
      return 0;
    };
  });
}

}  // namespace drape::app
