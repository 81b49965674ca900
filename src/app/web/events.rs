//! What a page hears from the program.

use std::cell::RefCell;
use std::rc::Rc;

use js_sys::{Function, Object, Reflect};
use wasm_bindgen::prelude::*;

use crate::app::App;
use crate::app::features::stepping::Stepping;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
/** The events that a page can listen to, and what it is told. */
export interface MeshbrushEvents {
  /** The program has started. */
  started: {};
  /** The mesh follows the document as it is. */
  complete: { triangles: number };
  /** The document has changed: by a stroke, a setting, undo or another document. */
  changed: { name: string };
  /** The window shows another message, or none. */
  message: { text?: string; failed: boolean };
  /** Another step of the refinement is shown, by the number of those that are done; none once they are left. */
  step: { step?: number; steps: number };
}
export interface Meshbrush {
  /** Calls a function at each event, after the frame in which it came. */
  on<E extends keyof MeshbrushEvents>(event: E, callback: (detail: MeshbrushEvents[E]) => void): void;
  /** Ends that. */
  off<E extends keyof MeshbrushEvents>(event: E, callback: (detail: MeshbrushEvents[E]) => void): void;
}
"#;

/// The names of all events.
const NAMES: [&str; 5] = ["started", "complete", "changed", "message", "step"];

/// The functions of the page, by the number of their event. Copies share them.
#[derive(Clone, Default)]
pub struct Listeners(Rc<RefCell<Vec<(usize, Function)>>>);

/// What the page was told last.
#[derive(Clone, PartialEq, Default)]
struct Told {
    started: bool,
    /// The revision of the mesh, once it follows the document.
    complete: Option<u64>,
    changed: Option<u64>,
    /// The number of the message, and its text: a question can change.
    message: Option<(u64, String)>,
    step: Option<usize>,
}

/// Compares the program after each frame with what the page was told.
pub struct Herald {
    listeners: Listeners,
    told: Told,
}

impl Listeners {
    /// Adds a function.
    ///
    /// # Errors
    /// Fails with a sentence for another name.
    pub fn add(&self, event: &str, callback: Function) -> Result<(), JsError> {
        self.0.borrow_mut().push((number_of(event)?, callback));
        Ok(())
    }

    /// Removes a function.
    ///
    /// # Errors
    /// Fails with a sentence for another name.
    pub fn remove(&self, event: &str, callback: &Function) -> Result<(), JsError> {
        let number = number_of(event)?;
        self.0.borrow_mut().retain(|(event, known)| *event != number || known != callback);
        Ok(())
    }

    /// Calls the functions of an event, once nobody holds the program: they may call it.
    fn call(&self, event: &str, detail: Vec<(&str, JsValue)>) {
        let called = self.0.borrow().iter().filter(|(number, _)| NAMES[*number] == event).cloned().collect();
        let called: Vec<(usize, Function)> = called;
        if called.is_empty() {
            return;
        }
        let object = Object::new();
        for (key, value) in detail.into_iter().filter(|(_, value)| !value.is_undefined()) {
            _ = Reflect::set(&object, &key.into(), &value);
        }
        wasm_bindgen_futures::spawn_local(async move {
            for (_, callback) in called {
                if let Err(problem) = callback.call1(&JsValue::UNDEFINED, &object) {
                    web_sys::console::error_1(&problem);
                }
            }
        });
    }
}

fn number_of(event: &str) -> Result<usize, JsError> {
    let number = NAMES.iter().position(|name| *name == event);
    let known = NAMES.join(", ");
    number.ok_or_else(|| JsError::new(&format!("There is no event “{event}”; there are {known}.")))
}

impl Herald {
    /// Returns one that has told nothing yet.
    pub fn new(listeners: Listeners) -> Self {
        Self { listeners, told: Told::default() }
    }

    /// Tells the page what is new.
    pub fn tell(&mut self, app: &App) {
        let (session, steps) = (&app.session, app.features.get::<Stepping>().steps());
        let (follower, document) = (session.follower(), session.document());
        let rests = follower.is_in_step(document) && document.is_stroke_drawn();
        let shown = session.notices().shown();
        let player = steps.and_then(|steps| steps.player());
        let now = Told {
            started: true,
            // While the mesh is on its way, it is still the one that was told last.
            complete: if rests { Some(document.revision()) } else { self.told.complete },
            changed: Some(document.revision()),
            message: shown.map(|notice| (notice.number, notice.text.clone())),
            step: player.map(|player| player.position()),
        };
        let before = std::mem::replace(&mut self.told, now);
        let (now, listeners) = (&self.told, &self.listeners);
        if !before.started {
            listeners.call("started", Vec::new());
        }
        if before.changed != now.changed {
            listeners.call("changed", vec![("name", document.settings().name.as_str().into())]);
        }
        if before.complete != now.complete {
            let triangles = session.triangle_count() as f64;
            listeners.call("complete", vec![("triangles", triangles.into())]);
        }
        if before.message != now.message {
            let text = shown.map_or(JsValue::UNDEFINED, |notice| notice.text.as_str().into());
            let failed = shown.is_some_and(|notice| notice.failed);
            listeners.call("message", vec![("text", text), ("failed", failed.into())]);
        }
        if before.step != now.step {
            let step = now.step.map_or(JsValue::UNDEFINED, |step| (step as f64).into());
            let steps = player.map_or(0.0, |player| player.len() as f64);
            listeners.call("step", vec![("step", step), ("steps", steps.into())]);
        }
    }
}
