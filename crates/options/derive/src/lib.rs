//! `#[derive(Described)]` for the options and results of the workspace: see
//! `boresight_options`, which says what a description is and who reads it.

mod attributes;
mod choice;
mod record;

use proc_macro::TokenStream;
use syn::{Data, DeriveInput, parse_macro_input};

/// Describes a struct with named fields, or an enum without data, by what stands in its
/// definition: names, doc comments, types, and
///
/// - `#[option(default = EXPRESSION)]`: the default, in SI units and radians. Where a field has
///   one, `Default` is implemented; fields without one begin with the default of their type.
/// - `#[option(range = LOW..=HIGH)]`: what is allowed, `LOW..` without a limit above; of angles in
///   degrees.
/// - `#[option(positive)]`: any finite number above zero.
/// - `#[option(described_as = TYPE)]`: the type that serde carries the field as, by functions of its
///   own; such a field's check is written by hand.
/// - `#[option(typescript = "...")]`: the field's type in TypeScript, of a result that has it more
///   exactly than its type in Rust.
/// - `#[option(schema = "...")]`: the JSON Schema of a field with a type in TypeScript.
/// - `#[option(required)]`: the field has to be given though it has a default in Rust. So has a field
///   of a struct without `#[serde(default)]`, unless it is an `Option`.
/// - `#[serde(skip)]`: the field is not described.
/// - `#[serde(skip_serializing_if = ...)]`: the field may be absent in a result.
///
/// A field of type `boresight_options::Flat` is flattened outside Rust: the fields of its value are
/// among those of the struct.
///
/// `#[option(name = "...")]` on the type gives its name outside Rust, where that of the type would not
/// be the only one.
#[proc_macro_derive(Described, attributes(option))]
pub fn described(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    match &input.data {
        Data::Struct(data) => record::expand(&input, &data.fields),
        Data::Enum(data) => choice::expand(&input, data),
        Data::Union(_) => Err(syn::Error::new_spanned(&input, "a union cannot be described")),
    }
    .unwrap_or_else(syn::Error::into_compile_error)
    .into()
}
