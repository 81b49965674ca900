use super::*;

const A: f64 = 0.7;
const B: f64 = -1.3;

fn formula(source: &str) -> Formula {
    Formula::parse(source).unwrap_or_else(|e| panic!("{source}: {e}\n{}", e.pointer()))
}

/// Returns the value at (A, B).
fn value(source: &str) -> f64 {
    formula(source).eval(A, B)
}

fn mistake(source: &str) -> ParseError {
    Formula::parse(source).expect_err(source)
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

#[test]
fn numbers_are_read_as_written() {
    let numbers = [
        ("1", 1.0),
        (".5", 0.5),
        ("5.", 5.0),
        ("1e-3", 1e-3),
        ("1.25E+2", 125.0),
        ("0", 0.0),
        ("0e0", 0.0),
        ("0.1", 0.1),
        ("4.9e-324", 4.9e-324),
        ("1.7976931348623157e308", f64::MAX),
        ("00012", 12.0),
    ];
    for (source, expected) in numbers {
        assert_eq!(value(source), expected, "{source}");
    }
}

#[test]
fn operators_bind_in_the_documented_order() {
    let table = [
        // powers, signs
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("2**3**2", 512.0),
        ("2^-2^2", 0.0625),
        ("--2", 2.0),
        ("-+-2", 2.0),
        ("!0", 1.0),
        ("!2^0", 0.0),
        ("!x+1", 1.0),
        // products, sums
        ("2+3*4", 14.0),
        ("(2+3)*4", 20.0),
        ("7-4-2", 1.0),
        ("16/4/2", 2.0),
        ("2*3%4", 2.0),
        ("-7%4", 1.0),
        ("7%-4", -1.0),
        ("-8%4", 0.0),
        ("2*-3", -6.0),
        ("-2*3", -6.0),
        ("2*3^2", 18.0),
        ("1+2 < 4-0", 1.0),
        // comparisons
        ("1<1", 0.0),
        ("1<=1", 1.0),
        ("1>1", 0.0),
        ("1>=1", 1.0),
        ("1==1", 1.0),
        ("1!=1", 0.0),
        ("0<1<2", 1.0),
        ("0<2<1", 0.0),
        ("3>2>2", 0.0),
        ("3>2>=2", 1.0),
        ("1<=1==1<2<=2", 1.0),
        ("1==1==0", 0.0),
        ("-1 < x < 1", 1.0),
        ("-1 < y < 1", 0.0),
        ("-9 < y < x <= 0.7 < 1", 1.0),
        ("(0<1<2)+(2<1<5)", 1.0),
        // words
        ("not 1 == 2", 1.0),
        ("not not 3", 1.0),
        ("not 0 and 0", 0.0),
        ("not (0 and 0)", 1.0),
        ("1 or 1 and 0", 1.0),
        ("(1 or 1) and 0", 0.0),
        ("1 || 0 && 0", 1.0),
        ("0 or 0 or 5", 1.0),
        ("2 and 3", 1.0),
        ("1 < 2 and 2 < 3", 1.0),
        ("1 and not 0", 1.0),
        ("0*x and 1", 0.0),
        ("x or 1/0", 1.0),
        ("-0*(0.7-x) and 1", 0.0),
        // choices and calls
        ("if(x > 0, 2, 3)", 2.0),
        ("if(y > 0, 2, 3)", 3.0),
        ("if(y > 0, 2, if(x > 0, 4, 5)) + 1", 5.0),
        ("1 + if(x > y, 10, 20) * 2", 21.0),
        ("min(3, x, 2)", A),
        ("max(y, x, 1, 0)", 1.0),
        ("min(1,2)-max(1,2)", -1.0),
        ("clamp(5, 0, 1)", 1.0),
        ("clamp(5, 1, 0)", 0.0),
        ("mix(2, 6, 0.25)", 3.0),
        ("smoothstep(0, 1, 0.5)", 0.5),
        ("smoothstep(1, 1, 1)", 1.0),
        ("smoothstep(1, 0, 0.25)", 0.84375),
        // signs as pasted
        ("2×3·2÷4−1", 2.0),
        ("1≤1 and 1≥1 and 1≠2", 1.0),
        (" \t1\n+\u{a0}1 ", 2.0),
    ];
    for (source, expected) in table {
        assert_eq!(value(source), expected, "{source}");
    }
}

#[test]
fn coordinates_and_constants() {
    assert_eq!((value("x"), value("y")), (A, B));
    assert_eq!(value("r"), libm::hypot(A, B));
    assert_eq!(value("theta"), libm::atan2(B, A));
    assert_eq!(value("θ/π"), value("theta/pi"));
    assert_eq!(value("tau"), std::f64::consts::TAU);
    assert_eq!(value("e"), std::f64::consts::E);
    assert_eq!(value("inf"), f64::INFINITY);
}

#[test]
fn functions_agree_with_std() {
    type Std = fn(f64) -> f64;
    type Std2 = fn(f64, f64) -> f64;
    let one: &[(&str, Std)] = &[
        ("abs", f64::abs),
        ("sqrt", f64::sqrt),
        ("cbrt", f64::cbrt),
        ("exp", f64::exp),
        ("ln", f64::ln),
        ("log10", f64::log10),
        ("log2", f64::log2),
        ("sin", f64::sin),
        ("cos", f64::cos),
        ("tan", f64::tan),
        ("asin", f64::asin),
        ("acos", f64::acos),
        ("atan", f64::atan),
        ("sinh", f64::sinh),
        ("cosh", f64::cosh),
        ("tanh", f64::tanh),
        ("floor", f64::floor),
        ("ceil", f64::ceil),
        ("round", f64::round),
        ("trunc", f64::trunc),
        ("sign", |v| if v == 0.0 { v } else { v.signum() }),
        ("fract", |v| v.rem_euclid(1.0)),
    ];
    let two: &[(&str, Std2)] = &[
        ("atan2(x, y)", f64::atan2),
        ("hypot(x, y)", f64::hypot),
        ("pow(x, y)", f64::powf),
        ("x^y", f64::powf),
        ("min(x, y)", f64::min),
        ("max(x, y)", f64::max),
        ("mod(x, abs(y)+1)", |a, b| a.rem_euclid(b.abs() + 1.0)),
        ("step(x, y)", |a, b| if b < a { 0.0 } else { 1.0 }),
        ("gauss(x, y)", |d, s| (-0.5 * (d / s).powi(2)).exp()),
        ("clamp(x, -1, 1) - y", |a, b| a.clamp(-1.0, 1.0) - b),
        ("mix(x, y, 0.25)", |a, b| a + (b - a) * 0.25),
    ];
    let mut random = fastrand::Rng::with_seed(7);
    let mut number = || {
        let scale = [0.1, 1.0, 3.0, 30.0][random.usize(..4)];
        (random.f64() * 2.0 - 1.0) * scale
    };
    let close = |a: f64, b: f64| same(a, b) || (a - b).abs() <= 1e-14 * b.abs().max(1e-2);
    for _ in 0..2000 {
        let (x, y) = (number(), number());
        for (name, std) in one {
            let ours = formula(&format!("{name}(x)")).eval(x, y);
            assert!(close(ours, std(x)), "{name}({x}) = {ours}, std {}", std(x));
        }
        for (source, std) in two {
            let (ours, theirs) = (formula(source).eval(x, y), std(x, y));
            assert!(close(ours, theirs), "{source} at {x}, {y}: {ours}, std {theirs}");
        }
    }
}

#[test]
fn every_listed_function_can_be_called_as_listed() {
    for (call, meaning) in functions() {
        let name = call.split('(').next().unwrap();
        let count = call.matches(',').count() + 1;
        let source = format!("{name}({})", vec!["x"; count].join(", "));
        formula(&source);
        assert!(!meaning.is_empty());
    }
}

#[test]
fn nan_is_not_lost_in_min_max_clamp_or_step() {
    for source in [
        "min(0/0, x)",
        "min(x, 0/0)",
        "max(0/0, x)",
        "max(x, 0/0)",
        "max(x, 0/0, 1)",
        "clamp(sqrt(-1), 0, 1)",
        "step(0, ln(-1))",
        "smoothstep(0, 1, 0/0)",
        "sign(0/0)",
    ] {
        assert!(value(source).is_nan(), "{source}");
    }
}

/// Carets stand under the mistake in a fixed-width font: wide letters take two columns, accents none.
#[test]
fn carets_stand_under_wide_letters_and_accents() {
    for (source, pointer) in [
        ("x + 高さ", "x + 高さ\n    ^^^^"),
        ("x + e\u{301}te", "x + e\u{301}te\n    ^^^"),
        ("\u{1f30a}", "\u{1f30a}\n^^"),
    ] {
        assert_eq!(Formula::parse(source).unwrap_err().pointer(), pointer);
    }
}

/// Regression guard for golden number 5 of the design: no fused, reordered or widened arithmetic.
#[test]
fn sums_are_plain_f64_in_the_order_written() {
    let norm = formula("abs(x)+abs(y)<8");
    let sum = formula("x+0.1+0.2");
    let product = formula("x*y+0.3");
    let mut random = fastrand::Rng::with_seed(5);
    for _ in 0..20_000 {
        let x = random.f64() * 16.0 - 8.0;
        let y = f64::from_bits((8.0 - x.abs()).to_bits().wrapping_add(random.u64(..3)));
        assert_eq!(norm.eval(x, y), f64::from(u8::from(x.abs() + y.abs() < 8.0)));
        assert_eq!(sum.eval(x, y), (x + 0.1) + 0.2);
        assert_eq!(product.eval(x, y), x * y + 0.3);
    }
    assert_eq!(norm.eval(-3.25, 4.75), 0.0);
    assert_eq!(norm.eval(-3.25, 4.75 - f64::EPSILON * 4.0), 1.0);
}

#[test]
fn constants_are_folded_and_only_they() {
    assert_eq!(formula("if(1<2, 3+4, sqrt(2))").constant(), Some(7.0));
    assert_eq!(formula("0<1<2 and not 3").constant(), Some(0.0));
    assert_eq!(formula("max(1, 2, 3)").constant(), Some(3.0));
    assert_eq!(formula("if(1, x, 2)").constant(), None);
    assert_eq!(formula("x*2*3").program.len(), 5);
    assert_eq!(formula("x*(2*3)").program.len(), 3);
    // A constant after a choice is not folded into its last branch.
    assert_eq!(value("if(x>0, 1, 2)+3"), 4.0);
    assert_eq!(value("if(x<0, 1, 2)+3"), 5.0);
    assert_eq!(value("(y or 0)*3"), 3.0);
}

#[test]
fn a_mistake_has_its_place_and_its_sentence() {
    let table: &[(&str, std::ops::Range<usize>, &str)] = &[
        ("", 0..0, "empty"),
        ("  ", 0..2, "empty"),
        ("1 +", 3..3, "found the end of the formula"),
        ("1 + * 2", 4..5, "found `*`"),
        (")", 0..1, "found `)`"),
        ("1)", 1..2, "has no `(`"),
        ("(1", 0..1, "never closed"),
        ("min(1, (2)", 3..4, "never closed"),
        ("()", 1..2, "Expected a value"),
        ("2x", 1..2, "to multiply, write `*`"),
        ("2 3", 2..3, "to multiply, write `*`"),
        ("1.2.3", 3..5, "to multiply"),
        ("(x)(y)", 3..4, "to multiply"),
        ("x(y)", 0..2, "`x` is not a function; to multiply, write `x*(`"),
        ("0,4", 1..2, "decimal fraction"),
        ("abs(0,4)", 0..3, "takes 1 value; found 2. A decimal fraction"),
        ("1+atan2(y)", 2..7, "`atan2(y, x)` takes 2 values; found 1."),
        ("if(x, 1)", 0..2, "`if(c, a, b)` takes 3 values; found 2."),
        ("if(1, 2, 3, 4)", 0..2, "found 4."),
        ("min(1)", 0..3, "at least 2 values; found 1"),
        ("abs()", 0..3, "found 0"),
        ("min(1,)", 6..7, "Expected a value"),
        ("abs x", 0..3, "in parentheses: `abs(v)`"),
        ("sine(x)", 0..4, "There is no `sine`; write `sin(v)`."),
        ("X + 1", 0..1, "write `x`"),
        ("2*PI", 2..4, "write `pi`"),
        ("Abs(x)", 0..3, "write `abs(v)`"),
        ("smoothstpe(0,1,x)", 0..10, "write `smoothstep(lo, hi, v)`"),
        ("log(x)", 0..3, "`ln(v)` for base e"),
        ("wibble", 0..6, "There is no `wibble`; the coordinates are"),
        ("x = 1", 2..3, "write `==`"),
        ("x <> 1", 2..4, "write `!=`"),
        ("x & y", 2..3, "`and`"),
        ("|x|", 0..1, "`abs(v)`"),
        ("x ? 1 : 2", 2..3, "`if(c, a, b)`"),
        ("x if y else 1", 2..4, "`if(c, a, b)`"),
        ("x AND y", 2..5, "`and` in small letters"),
        ("x mod 2", 2..5, "`a % b`"),
        ("x²", 1..3, "write `^2`"),
        ("θ + größe", 5..12, "There is no `größe`"),
        ("min(1;2)", 5..6, "comma"),
        ("1 + not x", 4..7, "parentheses"),
        ("0 < x > 1", 6..7, "one way"),
        ("0 != x != 1", 7..9, "one way"),
        ("1e999", 0..5, "too large"),
        ("1e-999", 0..6, "too small"),
        ("x + .", 4..5, "digit"),
        ("x !", 2..3, "operator was expected"),
        ("x\u{202e}", 1..4, "no meaning"),
    ];
    for (source, span, words) in table {
        let e = mistake(source);
        assert_eq!(e.span(), *span, "{source}: {e}");
        assert!(e.to_string().contains(words), "{source}: {e}");
        assert!(e.to_string().ends_with('.'), "{source}: {e}");
    }
}

#[test]
fn the_pointer_stands_under_the_mistake() {
    assert_eq!(mistake("1 +").pointer(), "1 +\n   ^");
    assert_eq!(mistake("").pointer(), "\n^");
    assert_eq!(mistake("x +\n\tfoo").pointer(), "x +  foo\n     ^^^");
    assert_eq!(mistake("π·x + 日本").pointer(), "π·x + 日本\n      ^^^^");
    assert_eq!(mistake("x\u{0} + 1").pointer(), "x\u{fffd} + 1\n ^");

    let long = format!("{} foo {}", "x+".repeat(100), "+y".repeat(100));
    let pointer = mistake(&long).pointer().to_owned();
    let (text, carets) = pointer.split_once('\n').unwrap();
    assert!(text.chars().count() <= 70 && text.starts_with('…') && text.ends_with('…'));
    let column = carets.find('^').unwrap();
    assert_eq!(text.chars().skip(column).take(3).collect::<String>(), "foo");
    assert_eq!(carets.trim(), "^^^");
}

#[test]
fn a_long_name_is_cut_in_the_sentence() {
    let e = mistake(&"z".repeat(60_000));
    assert!(e.to_string().len() < 150, "{e}");
    assert!(e.pointer().chars().count() <= 141);
}

#[test]
fn nesting_and_length_are_bounded() {
    let deep = |open: &str, close: &str, n: usize| {
        Formula::parse(&format!("{}x{}", open.repeat(n), close.repeat(n)))
    };
    let shapes = [
        ("(", ")"),
        ("-", ""),
        ("not ", ""),
        ("x^", ""),
        ("1+(", ")"),
        ("abs(", ")"),
        ("clamp(x,y,", ")"),
        ("0<x<(", ")"),
        ("if(x,y,", ")"),
        ("y or (", ")"),
    ];
    for (open, close) in shapes {
        // The stack of the machine holds the deepest formula that is let through.
        let fits = (1..=MAX_NESTING).rev().find_map(|n| deep(open, close, n).ok());
        let fits = fits.unwrap_or_else(|| panic!("{open}"));
        assert!(fits.source().len() >= open.len() * (MAX_NESTING / 2 - 1));
        fits.eval(A, B);
        let e = deep(open, close, 5_000).unwrap_err();
        assert!(e.to_string().contains("nested deeper"), "{open}: {e}");
    }

    let sum = format!("x{}", "+x".repeat(MAX_LENGTH / 2 - 1));
    assert_eq!(formula(&sum).eval(1.0, 0.0), (MAX_LENGTH / 2) as f64);
    let chain = format!("x{}", "<=x".repeat(20_000));
    assert_eq!(value(&chain), 1.0);
    let many = format!("max(x{})", ",x".repeat(20_000));
    assert_eq!(value(&many), A);
    let too_many = format!("clamp(1{})", ",1".repeat(20_000));
    assert!(mistake(&too_many).to_string().contains("found 20001"));

    let e = mistake(&"π".repeat(MAX_LENGTH));
    assert!(e.to_string().contains("bytes long"), "{e}");
    assert_eq!(e.span(), MAX_LENGTH..2 * MAX_LENGTH);
}

/// Raw characters, raw bytes, pieces of formulas in any order, and formulas with a character changed.
#[test]
fn no_text_makes_it_panic() {
    let pieces = [
        "x", "y", "r", "theta", "1", ".5", "1e", "1e9", "e", "+", "-", "*", "/", "%", "^", "**", "<", "<=",
        "==", "!=", "!", "=", "and", "or", "not", " ", "(", ")", "(", ")", ",", "if(", "min(", "clamp(",
        "sin(", "abs", "foo", "π", "²", "日", "\u{301}", "\n", "\u{0}", "&&", "||", "|", "…", ".", "🙂",
        "\u{feff}",
    ];
    const GOOD: &str = "if(not 0<=abs(x)+r<0.4 and y, 1e-3, min(x^2,-y%3))";
    let mut random = fastrand::Rng::with_seed(11);
    let mut parsed = 0;
    for _ in 0..60_000 {
        let length = random.usize(..14);
        let source: String = match random.u8(..4) {
            0 => (0..length).map(|_| random.char(..)).collect(),
            1 => {
                let bytes: Vec<u8> = (0..length).map(|_| random.u8(..)).collect();
                String::from_utf8_lossy(&bytes).into_owned()
            }
            2 => {
                let mut letters: Vec<char> = GOOD.chars().collect();
                let at = random.usize(..letters.len());
                match random.bool() {
                    true => drop(letters.remove(at)),
                    false => letters[at] = random.choice(letters.clone()).unwrap_or('x'),
                }
                letters.into_iter().collect()
            }
            _ => (0..length).map(|_| pieces[random.usize(..pieces.len())]).collect(),
        };
        match Formula::parse(&source) {
            Ok(f) => {
                parsed += 1;
                f.eval(A, B);
                f.eval(f64::NAN, f64::INFINITY);
            }
            Err(e) => {
                assert!(source.get(e.span()).is_some(), "{source:?}");
                let (text, carets) = e.pointer().split_once('\n').unwrap();
                assert!(text.chars().count() <= 70 && carets.contains('^'));
            }
        }
    }
    assert!(parsed > 500, "{parsed}");
}

#[test]
fn formulas_are_shared_and_compared_by_text() {
    fn crosses_threads<T: Send + Sync + Clone>(_: &T) {}
    let f: Formula = "x + 1".parse().unwrap();
    crosses_threads(&f);
    assert_eq!(f, f.clone());
    assert_ne!(f, formula("x+1"));
    assert_eq!(f.to_string(), f.source());
}

/// An evaluator that shares no code with the compiler: a tree, walked.
mod referee {
    use super::{Formula, same};

    enum Tree {
        Number(f64),
        X,
        Y,
        Prefix(&'static str, Box<Tree>),
        Infix(&'static str, Box<Tree>, Box<Tree>),
        Chain(Box<Tree>, Vec<(&'static str, Tree)>),
        Call(&'static str, Vec<Tree>),
    }
    use Tree::{Call, Chain, Infix, Number, Prefix, X, Y};

    const INFIX: [&str; 14] = ["or", "and", "<", "<=", ">", ">=", "==", "!=", "+", "-", "*", "/", "%", "^"];
    const CALLS: [(&str, usize); 12] = [
        ("if", 3),
        ("abs", 1),
        ("min", 2),
        ("min", 4),
        ("max", 3),
        ("sqrt", 1),
        ("sin", 1),
        ("hypot", 2),
        ("clamp", 3),
        ("mix", 3),
        ("atan2", 2),
        ("floor", 1),
    ];

    fn grow(random: &mut fastrand::Rng, depth: usize) -> Tree {
        let child = |random: &mut fastrand::Rng| grow(random, depth - 1);
        let kind = if depth == 0 { 0 } else { random.u8(0..12) };
        match kind {
            0 => match random.u8(..5) {
                0 | 1 => X,
                2 => Y,
                3 => Number(f64::from(random.u8(..4))),
                _ => Number(random.f64() * 3.0),
            },
            1 => Prefix("-", Box::new(child(random))),
            2 => Prefix(["!", "not "][random.usize(..2)], Box::new(child(random))),
            3 => {
                let signs = [["<", "<=", "=="], [">", ">=", "=="]][random.usize(..2)];
                let first = Box::new(child(random));
                let count = random.usize(2..5);
                let link = |_| (signs[random.usize(..3)], child(random));
                Chain(first, (0..count).map(link).collect())
            }
            4..=6 => {
                let (name, count) = CALLS[random.usize(..CALLS.len())];
                Call(name, (0..count).map(|_| child(random)).collect())
            }
            _ => {
                let sign = INFIX[random.usize(..INFIX.len())];
                Infix(sign, Box::new(child(random)), Box::new(child(random)))
            }
        }
    }

    /// Loosest 1 to tightest 9, as the table in the module's documentation.
    fn rank(tree: &Tree) -> u8 {
        match tree {
            Infix("or", ..) => 1,
            Infix("and", ..) => 2,
            Prefix("not ", _) => 3,
            Chain(..) | Infix("<" | "<=" | ">" | ">=" | "==" | "!=", ..) => 4,
            Infix("+" | "-", ..) => 5,
            Infix("*" | "/" | "%", ..) => 6,
            Prefix(..) => 7,
            Infix(..) => 8,
            _ => 9,
        }
    }

    /// Prints the formula with the parentheses that it needs, and sometimes a few more.
    fn print(tree: &Tree, least: u8, random: &mut fastrand::Rng) -> String {
        let text = match tree {
            Number(v) => format!("{v}"),
            X => "x".into(),
            Y => "y".into(),
            Prefix(sign, a) => {
                let least = if *sign == "not " { 3 } else { 7 };
                format!("{sign}{}", print(a, least, random))
            }
            Infix(sign, a, b) => {
                let own = rank(tree);
                let (left, right) = match own {
                    4 => (5, 5),
                    8 => (9, 7),
                    _ => (own, own + 1),
                };
                let (a, b) = (print(a, left, random), print(b, right, random));
                format!("{a} {sign} {b}")
            }
            Chain(first, links) => {
                let mut text = print(first, 5, random);
                for (sign, next) in links {
                    text += &format!("{sign}{}", print(next, 5, random));
                }
                text
            }
            Call(name, values) => {
                let values: Vec<_> = values.iter().map(|v| print(v, 1, random)).collect();
                format!("{name}({})", values.join(","))
            }
        };
        if rank(tree) < least || random.u8(..12) == 0 { format!("({text})") } else { text }
    }

    fn holds(sign: &str, a: f64, b: f64) -> bool {
        match sign {
            "<" => a < b,
            "<=" => a <= b,
            ">" => a > b,
            ">=" => a >= b,
            "==" => a == b,
            "!=" => a != b,
            _ => unreachable!("{sign}"),
        }
    }

    fn walk(tree: &Tree, x: f64, y: f64) -> f64 {
        let bit = |b: bool| if b { 1.0 } else { 0.0 };
        let at = |t: &Tree| walk(t, x, y);
        match tree {
            Number(v) => *v,
            X => x,
            Y => y,
            Prefix("-", a) => -at(a),
            Prefix(_, a) => bit(at(a) == 0.0),
            Infix("or", a, b) => bit(at(a) != 0.0 || at(b) != 0.0),
            Infix("and", a, b) => bit(at(a) != 0.0 && at(b) != 0.0),
            Infix("+", a, b) => at(a) + at(b),
            Infix("-", a, b) => at(a) - at(b),
            Infix("*", a, b) => at(a) * at(b),
            Infix("/", a, b) => at(a) / at(b),
            Infix("%", a, b) => {
                let (a, b) = (at(a), at(b));
                let m = a % b;
                if m * b < 0.0 { m + b } else { m }
            }
            Infix("^", a, b) => match (at(a), at(b)) {
                (a, 2.0) => a * a,
                (a, b) => libm::pow(a, b),
            },
            Infix(sign, a, b) => bit(holds(sign, at(a), at(b))),
            Chain(first, links) => {
                let mut all = true;
                let mut before = at(first);
                for (sign, next) in links {
                    let next = at(next);
                    all &= holds(sign, before, next);
                    before = next;
                }
                bit(all)
            }
            Call("if", v) => at(if at(&v[0]) != 0.0 { &v[1] } else { &v[2] }),
            Call(name, v) => {
                let v: Vec<f64> = v.iter().map(at).collect();
                call(name, &v)
            }
        }
    }

    fn call(name: &str, v: &[f64]) -> f64 {
        let pick = |values: &[f64], better: fn(f64, f64) -> bool| {
            let mut best = values[0];
            for &v in &values[1..] {
                if v.is_nan() || best.is_nan() {
                    return f64::NAN;
                }
                best = if better(best, v) { best } else { v };
            }
            best
        };
        match name {
            "abs" => v[0].abs(),
            "sqrt" => v[0].sqrt(),
            "floor" => v[0].floor(),
            "sin" => libm::sin(v[0]),
            "hypot" => libm::hypot(v[0], v[1]),
            "atan2" => libm::atan2(v[0], v[1]),
            "min" => pick(v, |a, b| a < b),
            "max" => pick(v, |a, b| a > b),
            "clamp" => {
                let raised = pick(&v[..2], |a, b| a > b);
                pick(&[raised, v[2]], |a, b| a < b)
            }
            "mix" => v[0] * (1.0 - v[2]) + v[1] * v[2],
            _ => unreachable!("{name}"),
        }
    }

    #[test]
    fn the_program_equals_the_walked_tree() {
        let mut random = fastrand::Rng::with_seed(3);
        let points = [(0.7, -1.3), (0.0, 0.0), (1.0, 2.0), (-2.0, 1e-9), (1e6, 0.5)];
        for _ in 0..20_000 {
            let depth = random.usize(1..6);
            let tree = grow(&mut random, depth);
            let source = print(&tree, 1, &mut random);
            let formula =
                Formula::parse(&source).unwrap_or_else(|e| panic!("{e}\n{}\n{source}", e.pointer()));
            for (x, y) in points {
                let (ours, theirs) = (formula.eval(x, y), walk(&tree, x, y));
                assert!(same(ours, theirs), "{source} at {x}, {y}: {ours}, referee {theirs}");
            }
        }
    }
}
