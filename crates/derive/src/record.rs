//! Structs with named fields.

use crate::attributes::{FieldOptions, Range, Serde, doc, type_name};
use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Fields, Result, Type};

pub fn expand(input: &DeriveInput, fields: &Fields) -> Result<TokenStream> {
    let Fields::Named(fields) = fields else {
        return Err(syn::Error::new_spanned(input, "the fields of a record have names"));
    };
    let (ident, name, type_doc) = (&input.ident, type_name(input)?, doc(&input.attrs));
    if !input.generics.params.is_empty() {
        return Err(syn::Error::new_spanned(&input.generics, "a record has no parameters"));
    }
    let has_defaults = Serde::read(&input.attrs)?.default;
    let (mut described, mut checks, mut defaults, mut has_default) =
        (vec![], vec![], vec![], false);
    for field in &fields.named {
        let options = FieldOptions::read(&field.attrs)?;
        let serde = Serde::read(&field.attrs)?;
        let (ident, ty) = (&field.ident, &field.ty);
        let default = options.default.as_ref().map_or_else(
            || quote!(::core::default::Default::default()),
            |expression| quote!(#expression),
        );
        has_default |= options.default.is_some();
        defaults.push(quote!(#ident: #default));
        if serde.skip {
            continue;
        }
        let own = ident.as_ref().map(ToString::to_string).unwrap_or_default();
        let wire = serde.rename.unwrap_or(own);
        let spread = wire.starts_with("..");
        let required =
            options.required || !(has_defaults || serde.default || spread || is_option(ty));
        let (doc, may_be_absent) = (doc(&field.attrs), serde.may_be_absent);
        let range = range_tokens(options.range.as_ref());
        let described_as = options.described_as.as_ref().unwrap_or(ty);
        let place = described.len();
        described.push(quote! {
            ::boresight_core::describe::Field {
                name: #wire,
                doc: #doc,
                kind: <#described_as as ::boresight_core::describe::Described>::KIND,
                range: #range,
                may_be_absent: #may_be_absent,
                required: #required,
            }
        });
        if options.described_as.is_some() {
            continue;
        }
        let at = if spread { quote!(at) } else { quote!(&at.field(FIELDS[#place].name)) };
        checks.push(quote! {
            ::boresight_core::describe::Described::check(&self.#ident, FIELDS[#place].range, #at)?;
        });
    }
    let default = has_default.then(|| {
        quote! {
            impl ::core::default::Default for #ident {
                fn default() -> Self {
                    Self { #(#defaults),* }
                }
            }
        }
    });
    Ok(quote! {
        const _: () = {
            const FIELDS: &[::boresight_core::describe::Field] = &[#(#described),*];

            impl ::boresight_core::describe::Described for #ident {
                const KIND: ::boresight_core::describe::Kind = ::boresight_core::describe::Kind::Record(
                    &::boresight_core::describe::Record { name: #name, doc: #type_doc, fields: FIELDS },
                );

                fn check(
                    &self,
                    _: ::core::option::Option<::boresight_core::describe::Range>,
                    at: &::boresight_core::describe::At<'_>,
                ) -> ::core::result::Result<(), ::boresight_core::CoreError> {
                    #(#checks)*
                    ::core::result::Result::Ok(())
                }
            }

            #default
        };
    })
}

fn is_option(ty: &Type) -> bool {
    matches!(ty, Type::Path(path) if path.path.segments.last().is_some_and(|s| s.ident == "Option"))
}

fn range_tokens(range: Option<&Range>) -> TokenStream {
    let some =
        |range| quote!(::core::option::Option::Some(::boresight_core::describe::Range #range));
    match range {
        None => quote!(::core::option::Option::None),
        Some(Range::Positive) => some(quote!({ low: 0.0, high: f64::INFINITY, above_low: true })),
        Some(Range::Limits(low, Some(high))) => {
            some(quote!({ low: #low as f64, high: #high as f64, above_low: false }))
        }
        Some(Range::Limits(low, None)) => {
            some(quote!({ low: #low as f64, high: f64::INFINITY, above_low: false }))
        }
    }
}
