//! `--depth-slope`: the bound is proved on the files, edge by edge.

use crate::folder::Folder;

/// Nodes with depths, and triangles.
type Sea = (Vec<[f64; 3]>, Vec<[usize; 3]>);

/// Reads `.14` or `.gr3`.
fn read(text: &str) -> Sea {
    let numbers = |line: &str| -> Vec<f64> { line.split(' ').map(|word| word.parse().unwrap()).collect() };
    let mut lines = text.lines().skip(1);
    let counts = numbers(lines.next().unwrap());
    let nodes = (0..counts[1] as usize).map(|_| numbers(lines.next().unwrap()));
    let nodes = nodes.map(|row| [row[1], row[2], row[3]]).collect();
    let triangles = (0..counts[0] as usize).map(|_| numbers(lines.next().unwrap()));
    (nodes, triangles.map(|row| [2, 3, 4].map(|n| row[n] as usize - 1)).collect())
}

/// Returns the largest r-factor of an edge with water at both ends.
fn steepest((nodes, triangles): &Sea) -> f64 {
    let edges = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let factors = edges.filter_map(|ends| {
        let [a, b] = ends.map(|node| nodes[node][2]);
        (a > 0.0 && b > 0.0).then(|| (a - b).abs() / (a + b))
    });
    factors.fold(0.0, f64::max)
}

#[test]
fn no_edge_of_a_file_is_steeper_than_the_slope() {
    let folder = Folder::new("depth-slope");
    let mut random = fastrand::Rng::with_seed(65);
    for round in 0..12 {
        let [x, y, far] = [40.0 * random.f64(), 30.0 * random.f64(), 1.0 + 8.0 * random.f64()];
        let limit = [0.1, 0.2, 0.35, 0.6][round % 4];
        let sea = format!(
            "mesh --domain 0,0,40,30 --spacing 5 --target 0.5+0.1*hypot(x-{x},y-{y}) --quantity \
             depth=if(x+y<35,2+y/{far},900-20*x)+40*sin(x*y)"
        );
        let plain = folder.run(format!("{sea} -o plain.14"));
        assert_eq!(plain.status, 0, "{}", plain.err);
        let smooth =
            folder.run(format!("{sea} -o sea.14 -o sea.gr3 --least-depth 2.5 --depth-slope {limit} --json"));
        assert_eq!(smooth.status, 0, "{}", smooth.err);
        let (old, new) = (read(&folder.read("plain.14")), read(&folder.read("sea.14")));
        let raised: Vec<f64> = old.0.iter().map(|node| node[2].max(2.5)).collect();
        let before =
            (raised.iter().zip(&old.0).map(|(&depth, &[x, y, _])| [x, y, depth]).collect(), old.1.clone());
        assert!(
            steepest(&before) > limit && steepest(&new) <= limit,
            "{} {}",
            steepest(&before),
            steepest(&new)
        );
        assert!(new.0.iter().all(|node| node[2] >= 2.5));
        assert_eq!(read(&folder.read("sea.gr3")), new);
        let answer = &smooth.json()["depth_slope"];
        let changes = raised.iter().zip(&new.0).map(|(old, new)| new[2] - old);
        let changed = changes.clone().filter(|change| *change != 0.0).count();
        let largest = changes.fold(0.0, |largest: f64, change| largest.max(change.abs()));
        assert_eq!(answer["limit"], limit);
        assert_eq!(
            (&answer["before"], &answer["after"]),
            (&steepest(&before).into(), &steepest(&new).into())
        );
        assert_eq!(answer["changed"], changed);
        assert_eq!(answer["largest_change"].as_f64().unwrap().abs(), largest);
        assert!(answer["more_water"].as_f64().unwrap().abs() < 1e-3, "{answer}");
        let at = [0, 1].map(|axis| answer["at"][axis].as_f64().unwrap());
        let node = new.0.iter().position(|node| [node[0], node[1]] == at).unwrap();
        assert_eq!((new.0[node][2] - raised[node]).abs(), largest);
        let title = folder.read("sea.14").lines().next().unwrap().to_owned();
        let line = format!(
            "; least depth: 2.5 m; depth slope: r-factor of edges at most {limit}; {changed} nodes changed"
        );
        assert!(title.contains(&line), "{title}");
        assert!(smooth.err.contains(&format!("and is {limit} now:")), "{}", smooth.err);
        folder.run(format!("{sea} -o one.14 --least-depth 2.5 --depth-slope {limit} --threads 1"));
        assert_eq!(read(&folder.read("one.14")), new);
    }
}

#[test]
fn dry_nodes_are_said_and_impossible_slopes_refused() {
    let folder = Folder::new("depth-slope-dry");
    let sea = "mesh --domain 0,0,4,3 --spacing 1 --quantity depth=100*(x-1.5)";
    let ran = folder.run(format!("{sea} -o sea.14 --depth-slope 0.3"));
    assert!(ran.err.contains("8 nodes are dry (a depth of 0 or less)"), "{}", ran.err);
    assert!(steepest(&read(&folder.read("sea.14"))) <= 0.3);
    for slope in ["0", "1", "steep", "nan", "-0.2"] {
        let ran = folder.run(format!("{sea} --depth-slope {slope}"));
        assert!(ran.status == 2 && ran.err.contains("a number between 0 and 1"), "{}", ran.err);
    }
    let idle = folder.run("mesh --spacing 0.5 -o a.14 --depth-slope 0.2");
    assert!(idle.status == 0 && idle.err.contains("--depth-slope changes nothing"), "{}", idle.err);
    let gentle = folder.run("mesh --spacing 0.5 -o a.14 --quantity depth=9+x --depth-slope 0.9");
    assert!(
        gentle.err.contains("No edge has an r-factor above 0.9: depths are written as they are."),
        "{}",
        gentle.err
    );
    // check sees the same depths, and knows the option.
    let ran =
        folder.run("check --domain 0,0,4,3 --spacing 1 --quantity depth=x+1 --depth-slope 0.1 --for adcirc");
    assert!(ran.status == 0, "{}", ran.err);
}
