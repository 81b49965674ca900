//! All modules of the crate, for its own tests, benches and fuzz targets. There is no promise of stability.

macro_rules! modules {
    ($($name:ident)*) => {
        $(
            #[allow(missing_docs)]
            pub mod $name {
                pub use crate::$name::*;
            }
        )*
    };
}

modules! { text geometry mesh plot raster field domain layers outline paint build path explain document io colormap scene render }
