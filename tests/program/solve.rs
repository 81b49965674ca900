//! `meshbrush solve`: options, recipes, files, bad input.

use serde_json::Value;

use crate::folder::Folder;

const SQUARE: &str = "--spacing 0.1 --target 0.05";

fn number(answer: &Value, key: &str) -> f64 {
    answer[key].as_f64().unwrap_or_else(|| panic!("{key} of {answer}"))
}

#[test]
fn a_known_solution_is_met_within_the_bound() {
    let folder = Folder::new("solve");
    let sine = "--source 2*pi^2*sin(pi*x)*sin(pi*y) --dirichlet all=0 --exact sin(pi*x)*sin(pi*y)";
    let answer = folder.json("solve", format!("{SQUARE} {sine} -o u.vtu"));
    let [bound, error] = ["energy_error_bound", "energy_error"].map(|key| number(&answer, key));
    assert!(error <= bound && bound < 2.0 * error, "{answer}");
    assert_eq!((&answer["guaranteed"], &answer["mean_is_zero"]), (&true.into(), &false.into()));
    assert!((number(&answer, "energy_norm") - std::f64::consts::PI / 2.0_f64.sqrt()).abs() < 0.02);
    assert!(number(&answer, "steps") <= 15.0 && number(&answer, "nodes") > 800.0);
    assert!(folder.bytes("u.vtu").windows(8).any(|part| part == b"Name=\"u\""));
    let ran = folder.run(format!("solve {SQUARE} {sine}"));
    assert!(ran.out.contains("energy error at most 0."), "{}", ran.out);
}

#[test]
fn a_recipe_has_a_problem_and_options_replace_it() {
    let folder = Folder::new("solve-recipe");
    let text = "[mesh]\nspacing = 0.1\n[problem]\ndiffusion = \"1 + x\"\nsource = 3\nreaction = 0.5\n\
                dirichlet = { \"open west\" = 0, all = \"y\" }\nrobin = { \"open east\" = [2, \"1 + y\"] }\n\
                neumann = { \"open north\" = 1 }\nconvection = [1, \"x\"]\n";
    folder.file("a.toml", text);
    let by_recipe = folder.json("solve", "a.toml");
    let options = ["--spacing", "0.1", "--diffusion", "1 + x", "--source", "3", "--reaction", "0.5"];
    let conditions = ["--dirichlet", "open west=0", "--dirichlet", "all=y", "--robin", "open east=2;1 + y"];
    let rest = ["--neumann", "open north=1", "--convection", "1", "x"];
    let by_options = folder.json("solve", [&options[..], &conditions, &rest].concat());
    for key in ["nodes", "energy_norm", "energy_error_bound", "range", "peclet"] {
        assert_eq!(by_recipe[key], by_options[key], "{key}");
    }
    let other = folder.json("solve", ["a.toml", "--source", "0", "--neumann", "open west=1"]);
    assert_ne!(other["energy_norm"], by_recipe["energy_norm"]);
    assert_eq!(by_recipe["guaranteed"], false);
    let reasons = by_recipe["estimate_because"].to_string();
    assert!(reasons.contains("convection"), "{reasons}");
}

#[test]
fn bad_input_is_a_sentence() {
    let folder = Folder::new("solve-bad");
    folder.file("key.toml", "[problem]\ndifusion = 1\n");
    folder.file("formula.toml", "[problem]\ndirichlet = { all = \"1 + q\" }\n");
    for (options, status, sentence) in [
        ("--source 1", 1, "There is no solution: without a Dirichlet"),
        ("--diffusion x-0.5 --dirichlet all=0", 1, "The diffusion is -0.4"),
        ("--diffusion 0 --dirichlet all=0", 1, "it must be positive everywhere"),
        ("--reaction -1 --dirichlet all=0", 1, "The reaction is -1"),
        ("--source 1/(x-x) --dirichlet all=0", 1, "finite number everywhere"),
        ("--dirichlet 'open wst=0'", 1, "the most similar name is “open west”"),
        ("--dirichlet x+1", 2, "write the name of a piece of the boundary before the formula"),
        ("--dirichlet all=0 --dirichlet all=1", 2, "has one already"),
        ("--robin all=1", 2, "with a semicolon between them"),
        ("--dirichlet all=1+", 2, "--dirichlet: "),
        ("key.toml", 1, "`diffusion`"),
        ("formula.toml", 1, "line 2"),
    ] {
        let ran = folder.run(format!("solve {options}"));
        assert_eq!(ran.status, status, "{options}: {}", ran.err);
        assert!(ran.err.contains(sentence), "{options}: {}", ran.err);
    }
    let fast = folder.run("solve --spacing 0.1 --convection 100 0 --source 1 --dirichlet all=0");
    assert!(fast.err.contains("Péclet number") && fast.status == 0, "{}", fast.err);
    let free = folder.run("solve --spacing 0.1 --source 1 --neumann all=-0.25");
    assert!(free.err.contains("its mean is 0"), "{}", free.err);
}

#[test]
fn a_mesh_by_the_error_keeps_the_bound_or_the_number() {
    let folder = Folder::new("solve-error");
    let corner =
        "--domain -1,-1,1,1 --inside 'not (x>0 and y<0)' --spacing 0.25 --source 1 --dirichlet all=0";
    let answer = folder.json("solve", format!("{corner} --within 0.05"));
    assert!(number(&answer, "energy_error_bound") <= 0.05 && answer["guaranteed"] == true, "{answer}");
    let rounds = answer["rounds"].as_array().unwrap();
    let before = &rounds[rounds.len() - 2];
    assert!(number(before, "energy_error_bound") > 0.05);
    let most = folder.json("solve", format!("{corner} --at-most 1000 -o u.vtu"));
    assert!((700.0..=1000.0).contains(&number(&most, "triangles")), "{most}");
    let alone = folder.json("solve", format!("{corner} --at-most 1000 --threads 1"));
    assert_eq!(alone["rounds"], most["rounds"], "threads change no bit");
    let both = folder.run(format!("solve {corner} --at-most 1000 --within 0.1"));
    assert!(both.status == 2 && both.err.contains("cannot be used with"), "{}", both.err);
    let budget = folder.run(format!("solve {corner} --within 1e-4 --max-triangles 2000"));
    assert!(
        budget.status == 1 && budget.err.contains("A bound of 0.0001 is not reached: it is 0."),
        "{}",
        budget.err
    );
}
